/*
 * Industrial six-axis arm (OPW): the C of opw_arm.h for C++20, printed by closedform. Header only; every
 * function is one call of the C, with std::span for what it reads and std::array for what it returns.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_OPW_ARM_HPP
#define CLOSEDFORM_OPW_ARM_HPP

#include <array>
#include <cstdint>
#include <span>

#include "opw_arm_nearest.h"

namespace closedform::opw_arm {

using Parameters = opw_arm_params;

inline constexpr Parameters defaults = OPW_ARM_DEFAULTS;

[[nodiscard]] inline auto pose(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 16> result;
    opw_arm_pose(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto skeleton(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 24> result;
    opw_arm_skeleton(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto fk(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 16> result;
    opw_arm_fk(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 36> result;
    opw_arm_jacobian(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto determinant(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    opw_arm_determinant(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto singularities(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 3> result;
    opw_arm_singularities(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_space(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 36> result;
    opw_arm_jacobian_space(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_body(std::span<const real_t, 6> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 36> result;
    opw_arm_jacobian_body(&parameters, q.data(), result.data());
    return result;
}

struct IkResult {
    std::array<real_t, 48> q;
    std::array<uint8_t, 8> status;
};

[[nodiscard]] inline auto ik(std::span<const real_t, 16> T, const Parameters &parameters = defaults) noexcept
{
    IkResult result;
    opw_arm_ik(&parameters, T.data(), result.q.data(), result.status.data());
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

/* See opw_arm_nearest. */
[[nodiscard]] inline Nearest nearest(std::span<const real_t, 16> T, std::span<const real_t, 6> q_seed,
    const Limits *limits = nullptr, const std::array<real_t, 6> *weights = nullptr,
    const Parameters &parameters = defaults) noexcept
{
    static_assert(sizeof(Limits) == 2 * 6 * sizeof(real_t));
    Nearest found;
    found.branch = opw_arm_nearest(&parameters, T.data(), q_seed.data(),
        limits != nullptr ? limits->lower.data() : nullptr,
        weights != nullptr ? weights->data() : nullptr, found.q.data(), &found.status,
        found.outside.data());
    return found;
}

}  // namespace closedform::opw_arm

#endif
