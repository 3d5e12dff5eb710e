/* By hand: theta1, theta2, theta3, theta5, l1..l6 in; x, y, z, yaw out. The yaw is brought into
 * range by the remainder and not, as the generated one, by an arctangent. */
__attribute__((noinline)) void evaluate(const double *in, double *out)
{
    const double angles[4] = { in[0], in[1], in[1] + in[2], 0.0 };
    double s[4], c[4];
    cf_sincos_lanes(4, angles, s, c);
    const double r = in[4] + in[6] * s[1] + in[7] * c[2] + in[9];
    out[0] = -s[0] * r;
    out[1] = c[0] * r;
    out[2] = in[5] + in[6] * c[1] - in[7] * s[2] - in[8];
    const double yaw = in[0] + in[3];
    const double turns = (yaw * 0.15915494309189535 + 6755399441055744.0) - 6755399441055744.0;
    out[3] = yaw - turns * 6.283185307179586;
}
