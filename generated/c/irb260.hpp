/*
 * ABB IRB 260 palletiser: the C of irb260.h for C++20, printed by closedform. Header only; every
 * function is one call of the C, with std::span for what it reads and std::array for what it returns.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_IRB260_HPP
#define CLOSEDFORM_IRB260_HPP

#include <array>
#include <cstdint>
#include <span>

#include "irb260_nearest.h"

namespace closedform::irb260 {

using Parameters = irb260_params;

inline constexpr Parameters defaults = IRB260_DEFAULTS;

[[nodiscard]] inline auto joint4(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    irb260_joint4(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto joints_from_motors(std::span<const real_t, 4> motors, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 4> result;
    irb260_joints_from_motors(&parameters, motors.data(), result.data());
    return result;
}

[[nodiscard]] inline auto motors_from_joints(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 4> result;
    irb260_motors_from_joints(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto fk(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 4> result;
    irb260_fk(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto pose(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 16> result;
    irb260_pose(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto skeleton(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 33> result;
    irb260_skeleton(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 16> result;
    irb260_jacobian(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_space(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 24> result;
    irb260_jacobian_space(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_body(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 24> result;
    irb260_jacobian_body(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_motors(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 16> result;
    irb260_jacobian_motors(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto determinant(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    irb260_determinant(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto singularities(std::span<const real_t, 4> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 2> result;
    irb260_singularities(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto point_velocity(std::span<const real_t, 4> q, std::span<const real_t, 4> qdot, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 3> result;
    irb260_point_velocity(&parameters, q.data(), qdot.data(), result.data());
    return result;
}

struct IkResult {
    std::array<real_t, 16> q;
    std::array<uint8_t, 4> status;
};

[[nodiscard]] inline auto ik(std::span<const real_t, 4> x, const Parameters &parameters = defaults) noexcept
{
    IkResult result;
    irb260_ik(&parameters, x.data(), result.q.data(), result.status.data());
    return result;
}

[[nodiscard]] inline auto workspace_section(const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 4> result;
    irb260_workspace_section(&parameters, result.data());
    return result;
}

[[nodiscard]] inline auto workspace_margin(std::span<const real_t, 3> p, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    irb260_workspace_margin(&parameters, p.data(), result.data());
    return result;
}

[[nodiscard]] inline auto workspace_contains(std::span<const real_t, 3> p, const Parameters &parameters = defaults) noexcept
{
    std::array<uint8_t, 1> result;
    irb260_workspace_contains(&parameters, p.data(), result.data());
    return result;
}

/* The lower and the upper limits of all joints; without limits they are infinite. */
struct Limits {
    std::array<real_t, 4> lower, upper;
};

struct Nearest {
    std::array<real_t, 4> q;
    std::array<std::uint32_t, 4> outside; /* bits of joints, by branch */
    int branch;                                /* -1 if there is none */
    std::uint8_t status;
};

/* See irb260_nearest. */
[[nodiscard]] inline Nearest nearest(std::span<const real_t, 4> x, std::span<const real_t, 4> q_seed,
    const Limits *limits = nullptr, const std::array<real_t, 4> *weights = nullptr,
    const Parameters &parameters = defaults) noexcept
{
    static_assert(sizeof(Limits) == 2 * 4 * sizeof(real_t));
    Nearest found;
    found.branch = irb260_nearest(&parameters, x.data(), q_seed.data(),
        limits != nullptr ? limits->lower.data() : nullptr,
        weights != nullptr ? weights->data() : nullptr, found.q.data(), &found.status,
        found.outside.data());
    return found;
}

}  // namespace closedform::irb260

#endif
