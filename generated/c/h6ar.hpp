/*
 * H6AR, published model: the C of h6ar.h for C++20, printed by closedform. Header only; every
 * function is one call of the C, with std::span for what it reads and std::array for what it returns.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_H6AR_HPP
#define CLOSEDFORM_H6AR_HPP

#include <array>
#include <cstdint>
#include <span>

#include "h6ar_nearest.h"

namespace closedform::h6ar {

using Parameters = h6ar_params;

inline constexpr Parameters defaults = H6AR_DEFAULTS;

[[nodiscard]] inline auto fk(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 6> result;
    h6ar_fk(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto pose(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 16> result;
    h6ar_pose(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto arm_tips(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 6> result;
    h6ar_arm_tips(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto skeleton(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 60> result;
    h6ar_skeleton(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto invariant_point(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 3> result;
    h6ar_invariant_point(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 36> result;
    h6ar_jacobian(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto determinant(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    h6ar_determinant(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto singularities(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 6> result;
    h6ar_singularities(&parameters, q.data(), result.data());
    return result;
}

struct IkResult {
    std::array<real_t, 24> q;
    std::array<uint8_t, 4> status;
};

[[nodiscard]] inline auto ik(std::span<const real_t, 6> x, const Parameters &parameters = defaults) noexcept
{
    IkResult result;
    h6ar_ik(&parameters, x.data(), result.q.data(), result.status.data());
    return result;
}

[[nodiscard]] inline auto wrist_length(std::span<const real_t, 1> psi, std::span<const real_t, 1> phi, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    h6ar_wrist_length(&parameters, psi.data(), phi.data(), result.data());
    return result;
}

[[nodiscard]] inline auto minimum_link_length(std::span<const real_t, 1> psi_max, std::span<const real_t, 1> phi_max, std::span<const real_t, 1> beta_min, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    h6ar_minimum_link_length(&parameters, psi_max.data(), phi_max.data(), beta_min.data(), result.data());
    return result;
}

[[nodiscard]] inline auto largest_yaw(std::span<const real_t, 1> phi, std::span<const real_t, 1> beta_min, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    h6ar_largest_yaw(&parameters, phi.data(), beta_min.data(), result.data());
    return result;
}

[[nodiscard]] inline auto largest_angle(std::span<const real_t, 1> beta_min, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    h6ar_largest_angle(&parameters, beta_min.data(), result.data());
    return result;
}

/* The lower and the upper limits of all joints; without limits they are infinite. */
struct Limits {
    std::array<real_t, 6> lower, upper;
};

struct Nearest {
    std::array<real_t, 6> q;
    std::array<std::uint32_t, 4> outside; /* bits of joints, by branch */
    int branch;                                /* -1 if there is none */
    std::uint8_t status;
};

/* See h6ar_nearest. */
[[nodiscard]] inline Nearest nearest(std::span<const real_t, 6> x, std::span<const real_t, 6> q_seed,
    const Limits *limits = nullptr, const std::array<real_t, 6> *weights = nullptr,
    const Parameters &parameters = defaults) noexcept
{
    static_assert(sizeof(Limits) == 2 * 6 * sizeof(real_t));
    Nearest found;
    found.branch = h6ar_nearest(&parameters, x.data(), q_seed.data(),
        limits != nullptr ? limits->lower.data() : nullptr,
        weights != nullptr ? weights->data() : nullptr, found.q.data(), &found.status,
        found.outside.data());
    return found;
}

}  // namespace closedform::h6ar

#endif
