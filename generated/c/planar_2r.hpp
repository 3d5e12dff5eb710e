/*
 * Planar 2R arm: the C of planar_2r.h for C++20, printed by closedform. Header only; every
 * function is one call of the C, with std::span for what it reads and std::array for what it returns.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_PLANAR_2R_HPP
#define CLOSEDFORM_PLANAR_2R_HPP

#include <array>
#include <cstdint>
#include <span>

#include "planar_2r_nearest.h"

namespace closedform::planar_2r {

using Parameters = planar_2r_params;

inline constexpr Parameters defaults = PLANAR_2R_DEFAULTS;

[[nodiscard]] inline auto fk(std::span<const real_t, 2> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 2> result;
    planar_2r_fk(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto pose(std::span<const real_t, 2> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 16> result;
    planar_2r_pose(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto orientation(std::span<const real_t, 2> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    planar_2r_orientation(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto skeleton(std::span<const real_t, 2> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 9> result;
    planar_2r_skeleton(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian(std::span<const real_t, 2> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 6> result;
    planar_2r_jacobian(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto determinant(std::span<const real_t, 2> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    planar_2r_determinant(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto manipulability(std::span<const real_t, 2> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    planar_2r_manipulability(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto singularities(std::span<const real_t, 2> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 1> result;
    planar_2r_singularities(&parameters, q.data(), result.data());
    return result;
}

struct IkResult {
    std::array<real_t, 4> q;
    std::array<uint8_t, 2> status;
};

[[nodiscard]] inline auto ik(std::span<const real_t, 2> x, const Parameters &parameters = defaults) noexcept
{
    IkResult result;
    planar_2r_ik(&parameters, x.data(), result.q.data(), result.status.data());
    return result;
}

struct IkposeResult {
    std::array<real_t, 2> q;
    std::array<uint8_t, 1> status;
};

[[nodiscard]] inline auto ik_pose(std::span<const real_t, 16> T, const Parameters &parameters = defaults) noexcept
{
    IkposeResult result;
    planar_2r_ik_pose(&parameters, T.data(), result.q.data(), result.status.data());
    return result;
}

[[nodiscard]] inline auto workspace_radii(const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 2> result;
    planar_2r_workspace_radii(&parameters, result.data());
    return result;
}

/* The lower and the upper limits of all joints; without limits they are infinite. */
struct Limits {
    std::array<real_t, 2> lower, upper;
};

struct Nearest {
    std::array<real_t, 2> q;
    std::array<std::uint32_t, 2> outside; /* bits of joints, by branch */
    int branch;                                /* -1 if there is none */
    std::uint8_t status;
};

/* See planar_2r_nearest. */
[[nodiscard]] inline Nearest nearest(std::span<const real_t, 2> x, std::span<const real_t, 2> q_seed,
    const Limits *limits = nullptr, const std::array<real_t, 2> *weights = nullptr,
    const Parameters &parameters = defaults) noexcept
{
    static_assert(sizeof(Limits) == 2 * 2 * sizeof(real_t));
    Nearest found;
    found.branch = planar_2r_nearest(&parameters, x.data(), q_seed.data(),
        limits != nullptr ? limits->lower.data() : nullptr,
        weights != nullptr ? weights->data() : nullptr, found.q.data(), &found.status,
        found.outside.data());
    return found;
}

}  // namespace closedform::planar_2r

#endif
