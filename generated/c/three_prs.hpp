/*
 * 3-PRS mechanism: the C of three_prs.h for C++20, printed by closedform. Header only; every
 * function is one call of the C, with std::span for what it reads and std::array for what it returns.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_THREE_PRS_HPP
#define CLOSEDFORM_THREE_PRS_HPP

#include <array>
#include <cstdint>
#include <span>

#include "three_prs.h"

namespace closedform::three_prs {

using Parameters = three_prs_params;

inline constexpr Parameters defaults = THREE_PRS_DEFAULTS;

[[nodiscard]] inline auto hand_pose(std::span<const real_t, 3> x, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 16> result;
    three_prs_hand_pose(&parameters, x.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_parallel(std::span<const real_t, 3> x, std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 9> result;
    three_prs_jacobian_parallel(&parameters, x.data(), q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_serial(std::span<const real_t, 3> x, std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 3> result;
    three_prs_jacobian_serial(&parameters, x.data(), q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_inverse(std::span<const real_t, 3> x, std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 9> result;
    three_prs_jacobian_inverse(&parameters, x.data(), q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian(std::span<const real_t, 3> x, std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 9> result;
    three_prs_jacobian(&parameters, x.data(), q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto determinant(std::span<const real_t, 3> x, std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    three_prs_determinant(&parameters, x.data(), q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto singularities(std::span<const real_t, 3> x, std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 5> result;
    three_prs_singularities(&parameters, x.data(), q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto skeleton(std::span<const real_t, 3> x, std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 30> result;
    three_prs_skeleton(&parameters, x.data(), q.data(), result.data());
    return result;
}

struct IkResult {
    std::array<real_t, 24> q;
    std::array<uint8_t, 8> status;
};

[[nodiscard]] inline auto ik(std::span<const real_t, 3> x, const Parameters &parameters = defaults) noexcept
{
    IkResult result;
    three_prs_ik(&parameters, x.data(), result.q.data(), result.status.data());
    return result;
}

[[nodiscard]] inline auto workspace_contains(std::span<const real_t, 3> x, const Parameters &parameters = defaults) noexcept
{
    std::array<uint8_t, 1> result;
    three_prs_workspace_contains(&parameters, x.data(), result.data());
    return result;
}

}  // namespace closedform::three_prs

#endif
