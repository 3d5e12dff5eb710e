/*
 * Delta robot with rotary drives: the C of delta.h for C++20, printed by closedform. Header only; every
 * function is one call of the C, with std::span for what it reads and std::array for what it returns.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_DELTA_HPP
#define CLOSEDFORM_DELTA_HPP

#include <array>
#include <cstdint>
#include <span>

#include "delta_nearest.h"

namespace closedform::delta {

using Parameters = delta_params;

inline constexpr Parameters defaults = DELTA_DEFAULTS;

struct FkResult {
    std::array<real_t, 6> p;
    std::array<uint8_t, 2> status;
};

[[nodiscard]] inline auto fk(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    FkResult result;
    delta_fk(&parameters, q.data(), result.p.data(), result.status.data());
    return result;
}

[[nodiscard]] inline auto skeleton(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 132> result;
    delta_skeleton(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_parallel(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 18> result;
    delta_jacobian_parallel(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_serial(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 6> result;
    delta_jacobian_serial(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 18> result;
    delta_jacobian(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto determinant(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 2> result;
    delta_determinant(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto singularities(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 8> result;
    delta_singularities(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto condition_number(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 2> result;
    delta_condition_number(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto constraint(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 2> result;
    delta_constraint(&parameters, q.data(), result.data());
    return result;
}

struct IkResult {
    std::array<real_t, 24> q;
    std::array<uint8_t, 8> status;
};

[[nodiscard]] inline auto ik(std::span<const real_t, 3> x, const Parameters &parameters = defaults) noexcept
{
    IkResult result;
    delta_ik(&parameters, x.data(), result.q.data(), result.status.data());
    return result;
}

[[nodiscard]] inline auto workspace_contains(std::span<const real_t, 3> p, const Parameters &parameters = defaults) noexcept
{
    std::array<uint8_t, 1> result;
    delta_workspace_contains(&parameters, p.data(), result.data());
    return result;
}

/* The lower and the upper limits of all joints; without limits they are infinite. */
struct Limits {
    std::array<real_t, 3> lower, upper;
};

struct Nearest {
    std::array<real_t, 3> q;
    std::array<std::uint32_t, 8> outside; /* bits of joints, by branch */
    int branch;                                /* -1 if there is none */
    std::uint8_t status;
};

/* See delta_nearest. */
[[nodiscard]] inline Nearest nearest(std::span<const real_t, 3> x, std::span<const real_t, 3> q_seed,
    const Limits *limits = nullptr, const std::array<real_t, 3> *weights = nullptr,
    const Parameters &parameters = defaults) noexcept
{
    static_assert(sizeof(Limits) == 2 * 3 * sizeof(real_t));
    Nearest found;
    found.branch = delta_nearest(&parameters, x.data(), q_seed.data(),
        limits != nullptr ? limits->lower.data() : nullptr,
        weights != nullptr ? weights->data() : nullptr, found.q.data(), &found.status,
        found.outside.data());
    return found;
}

}  // namespace closedform::delta

#endif
