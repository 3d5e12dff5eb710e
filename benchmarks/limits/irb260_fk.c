/* By hand: theta1, theta2, theta3, theta5, l1..l6 in; x, y, z, yaw out. The yaw is brought into
 * range by the remainder. */
enum { ANGLES = 3 };

static inline void angles_of(const double *in, double *angles)
{
    angles[0] = in[0];
    angles[1] = in[1];
    angles[2] = in[1] + in[2];
}

static inline void body(const double *in, const double *s, const double *c, double *out)
{
    const double r = in[4] + in[6] * s[1] + in[7] * c[2] + in[9];
    out[0] = -s[0] * r;
    out[1] = c[0] * r;
    out[2] = in[5] + in[6] * c[1] - in[7] * s[2] - in[8];
    const double yaw = in[0] + in[3];
    const double turns = (yaw * 0.15915494309189535 + 6755399441055744.0) - 6755399441055744.0;
    out[3] = yaw - turns * 6.283185307179586;
}
