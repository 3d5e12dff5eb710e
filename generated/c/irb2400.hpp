/*
 * Six-axis arm on a parallelogram (IRB 2400): the C of irb2400.h for C++20, printed by closedform. Header only; every
 * function is one call of the C, with std::span for what it reads and std::array for what it returns.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_IRB2400_HPP
#define CLOSEDFORM_IRB2400_HPP

#include <array>
#include <cstdint>
#include <span>

#include "irb2400_nearest.h"

namespace closedform::irb2400 {

using Parameters = irb2400_params;

inline constexpr Parameters defaults = IRB2400_DEFAULTS;

[[nodiscard]] inline auto pose(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 16> result;
    irb2400_pose(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto skeleton(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 21> result;
    irb2400_skeleton(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto fk(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 16> result;
    irb2400_fk(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 36> result;
    irb2400_jacobian(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto determinant(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    irb2400_determinant(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto singularities(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 3> result;
    irb2400_singularities(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_space(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 36> result;
    irb2400_jacobian_space(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_body(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 36> result;
    irb2400_jacobian_body(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto joints_from_motors(std::span<const real_t, 6> motors, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 6> result;
    irb2400_joints_from_motors(&parameters, motors.data(), result.data());
    return result;
}

[[nodiscard]] inline auto motors_from_joints(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 6> result;
    irb2400_motors_from_joints(&parameters, q.data(), result.data());
    return result;
}

struct IkResult {
    std::array<real_t, 48> q;
    std::array<uint8_t, 8> status;
};

[[nodiscard]] inline auto ik(std::span<const real_t, 16> T, const Parameters &parameters = defaults) noexcept
{
    IkResult result;
    irb2400_ik(&parameters, T.data(), result.q.data(), result.status.data());
    return result;
}

/* The lower and the upper limits of all joints; without limits they are infinite. */
struct Limits {
    std::array<real_t, 6> lower, upper;
};

struct Nearest {
    std::array<real_t, 6> q;
    std::array<std::uint32_t, 8> outside; /* bits of joints, by branch */
    int branch;                                /* -1 if there is none */
    std::uint8_t status;
};

/* See irb2400_nearest. */
[[nodiscard]] inline Nearest nearest(std::span<const real_t, 16> T, std::span<const real_t, 6> q_seed,
    const Limits *limits = nullptr, const std::array<real_t, 6> *weights = nullptr,
    const Parameters &parameters = defaults) noexcept
{
    static_assert(sizeof(Limits) == 2 * 6 * sizeof(real_t));
    Nearest found;
    found.branch = irb2400_nearest(&parameters, T.data(), q_seed.data(),
        limits != nullptr ? limits->lower.data() : nullptr,
        weights != nullptr ? weights->data() : nullptr, found.q.data(), &found.status,
        found.outside.data());
    return found;
}

}  // namespace closedform::irb2400

#endif
