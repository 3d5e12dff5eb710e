/*
 * Agile wrist: the C of agile_wrist.h for C++20, printed by closedform. Header only; every
 * function is one call of the C, with std::span for what it reads and std::array for what it returns.
 * Do not edit: change the template and run make.
 */
#ifndef CLOSEDFORM_AGILE_WRIST_HPP
#define CLOSEDFORM_AGILE_WRIST_HPP

#include <array>
#include <cstdint>
#include <span>

#include "agile_wrist_nearest.h"

namespace closedform::agile_wrist {

using Parameters = agile_wrist_params;

inline constexpr Parameters defaults = AGILE_WRIST_DEFAULTS;

struct FkResult {
    std::array<real_t, 36> p;
    std::array<uint8_t, 4> status;
};

[[nodiscard]] inline auto fk(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    FkResult result;
    agile_wrist_fk(&parameters, q.data(), result.p.data(), result.status.data());
    return result;
}

[[nodiscard]] inline auto jacobian_parallel(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 36> result;
    agile_wrist_jacobian_parallel(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_serial(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 12> result;
    agile_wrist_jacobian_serial(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto jacobian_space(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 36> result;
    agile_wrist_jacobian_space(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto determinant(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 4> result;
    agile_wrist_determinant(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto singularities(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 16> result;
    agile_wrist_singularities(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto condition_number(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 4> result;
    agile_wrist_condition_number(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto passive_angles(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 12> result;
    agile_wrist_passive_angles(&parameters, q.data(), result.data());
    return result;
}

[[nodiscard]] inline auto skeleton(std::span<const real_t, 3> q, const Parameters &parameters = defaults) noexcept
{
    std::array<real_t, 132> result;
    agile_wrist_skeleton(&parameters, q.data(), result.data());
    return result;
}

struct IkResult {
    std::array<real_t, 24> q;
    std::array<uint8_t, 8> status;
};

[[nodiscard]] inline auto ik(std::span<const real_t, 9> R, const Parameters &parameters = defaults) noexcept
{
    IkResult result;
    agile_wrist_ik(&parameters, R.data(), result.q.data(), result.status.data());
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

/* See agile_wrist_nearest. */
[[nodiscard]] inline Nearest nearest(std::span<const real_t, 9> R, std::span<const real_t, 3> q_seed,
    const Limits *limits = nullptr, const std::array<real_t, 3> *weights = nullptr,
    const Parameters &parameters = defaults) noexcept
{
    static_assert(sizeof(Limits) == 2 * 3 * sizeof(real_t));
    Nearest found;
    found.branch = agile_wrist_nearest(&parameters, R.data(), q_seed.data(),
        limits != nullptr ? limits->lower.data() : nullptr,
        weights != nullptr ? weights->data() : nullptr, found.q.data(), &found.status,
        found.outside.data());
    return found;
}

}  // namespace closedform::agile_wrist

#endif
