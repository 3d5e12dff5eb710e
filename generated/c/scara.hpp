/*
 * SCARA arm (RRPR): the C of scara.h for C++20, printed by closedform. Header only; every
 * function is one call of the C, with std::span for what it reads and std::array for what it returns.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_SCARA_HPP
#define CLOSEDFORM_SCARA_HPP

#include <array>
#include <cstdint>
#include <span>

#include "scara_nearest.h"

namespace closedform::scara {

using Parameters = scara_params;

inline constexpr Parameters defaults = SCARA_DEFAULTS;

[[nodiscard]] inline auto pose(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 16> result;
    scara_pose(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto skeleton(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 15> result;
    scara_skeleton(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto fk(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 4> result;
    scara_fk(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 16> result;
    scara_jacobian(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto determinant(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    scara_determinant(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto singularities(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    scara_singularities(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_space(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 24> result;
    scara_jacobian_space(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_body(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 24> result;
    scara_jacobian_body(&parameters, q.data(), result.data());
    return result;
}

struct IkResult {
    std::array<real_t, 8> q;
    std::array<uint8_t, 2> status;
};

[[nodiscard]] inline auto ik(std::span<const real_t, 4> x, const Parameters &parameters = defaults) noexcept
{
    IkResult result;
    scara_ik(&parameters, x.data(), result.q.data(), result.status.data());
    return result;
}

/* The lower and the upper limits of all joints; without limits they are infinite. */
struct Limits {
    std::array<real_t, 4> lower, upper;
};

struct Nearest {
    std::array<real_t, 4> q;
    std::array<std::uint32_t, 2> outside; /* bits of joints, by branch */
    int branch;                                /* -1 if there is none */
    std::uint8_t status;
};

/* See scara_nearest. */
[[nodiscard]] inline Nearest nearest(std::span<const real_t, 4> x, std::span<const real_t, 4> q_seed,
    const Limits *limits = nullptr, const std::array<real_t, 4> *weights = nullptr,
    const Parameters &parameters = defaults) noexcept
{
    static_assert(sizeof(Limits) == 2 * 4 * sizeof(real_t));
    Nearest found;
    found.branch = scara_nearest(&parameters, x.data(), q_seed.data(),
        limits != nullptr ? limits->lower.data() : nullptr,
        weights != nullptr ? weights->data() : nullptr, found.q.data(), &found.status,
        found.outside.data());
    return found;
}

}  // namespace closedform::scara

#endif
