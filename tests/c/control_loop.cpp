#include <cstdio>

#include "ur_arm.hpp"

namespace arm = closedform::ur_arm;

int main()
{
    std::array<real_t, 6> q{0, -1.5, 1.6, -1.7, -1.6, 0};
    auto T = arm::fk(q);
    arm::Limits limits;
    limits.lower.fill(-6.28);
    limits.upper.fill(6.28);
    for (int cycle = 0; cycle < 500; ++cycle) {
        T[7] += 0.0004;
        const arm::Nearest found = arm::nearest(T, q, &limits);
        if (found.branch < 0) return 1;
        q = found.q;
    }
    const auto solutions = arm::ik(arm::fk(q));
    std::printf("%zu joint values, branch 0 is %s\n", solutions.q.size(),
        solutions.status[0] == CLOSEDFORM_OK ? "OK" : "not OK");
    return 0;
}
