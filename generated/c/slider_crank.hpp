/*
 * Slider-crank: the C of slider_crank.h for C++20, printed by closedform. Header only; every
 * function is one call of the C, with std::span for what it reads and std::array for what it returns.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_SLIDER_CRANK_HPP
#define CLOSEDFORM_SLIDER_CRANK_HPP

#include <array>
#include <cstdint>
#include <span>

#include "slider_crank_nearest.h"

namespace closedform::slider_crank {

using Parameters = slider_crank_params;

inline constexpr Parameters defaults = SLIDER_CRANK_DEFAULTS;

struct FkResult {
    std::array<real_t, 2> p;
    std::array<uint8_t, 2> status;
};

[[nodiscard]] inline auto fk(std::span<const real_t, 1> q, const Parameters &parameters = defaults) noexcept
{
    FkResult result;
    slider_crank_fk(&parameters, q.data(), result.p.data(), result.status.data());
    return result;
}

[[nodiscard]] inline auto skeleton(std::span<const real_t, 1> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 24> result;
    slider_crank_skeleton(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_parallel(std::span<const real_t, 1> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 2> result;
    slider_crank_jacobian_parallel(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_serial(std::span<const real_t, 1> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 2> result;
    slider_crank_jacobian_serial(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian(std::span<const real_t, 1> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 2> result;
    slider_crank_jacobian(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto determinant(std::span<const real_t, 1> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 2> result;
    slider_crank_determinant(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto singularities(std::span<const real_t, 1> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 4> result;
    slider_crank_singularities(&parameters, q.data(), result.data());
    return result;
}

struct IkResult {
    std::array<real_t, 2> q;
    std::array<uint8_t, 2> status;
};

[[nodiscard]] inline auto ik(std::span<const real_t, 1> x, const Parameters &parameters = defaults) noexcept
{
    IkResult result;
    slider_crank_ik(&parameters, x.data(), result.q.data(), result.status.data());
    return result;
}

[[nodiscard]] inline auto workspace_contains(std::span<const real_t, 1> p, const Parameters &parameters = defaults) noexcept
{
    std::array<uint8_t, 1> result;
    slider_crank_workspace_contains(&parameters, p.data(), result.data());
    return result;
}

/* The lower and the upper limits of all joints; without limits they are infinite. */
struct Limits {
    std::array<real_t, 1> lower, upper;
};

struct Nearest {
    std::array<real_t, 1> q;
    std::array<std::uint32_t, 2> outside; /* bits of joints, by branch */
    int branch;                                /* -1 if there is none */
    std::uint8_t status;
};

/* See slider_crank_nearest. */
[[nodiscard]] inline Nearest nearest(std::span<const real_t, 1> x, std::span<const real_t, 1> q_seed,
    const Limits *limits = nullptr, const std::array<real_t, 1> *weights = nullptr,
    const Parameters &parameters = defaults) noexcept
{
    static_assert(sizeof(Limits) == 2 * 1 * sizeof(real_t));
    Nearest found;
    found.branch = slider_crank_nearest(&parameters, x.data(), q_seed.data(),
        limits != nullptr ? limits->lower.data() : nullptr,
        weights != nullptr ? weights->data() : nullptr, found.q.data(), &found.status,
        found.outside.data());
    return found;
}

}  // namespace closedform::slider_crank

#endif
