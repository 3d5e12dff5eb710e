/* By hand: q1..q6, a2, a3, d3, d4 in; T row by row out. */
enum { ANGLES = 6 };

static inline void angles_of(const double *in, double *angles)
{
    angles[0] = in[0];
    angles[1] = in[1];
    angles[2] = in[1] + in[2];
    angles[3] = in[3];
    angles[4] = in[4];
    angles[5] = in[5];
}

static inline void body(const double *in, const double *s, const double *c, double *out)
{
    const double a2 = in[6], a3 = in[7], d3 = in[8], d4 = in[9];
    /* The wrist in axes of the forearm: Rz(q4) Ry(-q5) Rz(q6). */
    const double c45 = c[3] * c[4], s45 = s[3] * c[4];
    const double nx = c45 * c[5] - s[3] * s[5], ox = -c45 * s[5] - s[3] * c[5], ax = -c[3] * s[4];
    const double ny = s45 * c[5] + c[3] * s[5], oy = -s45 * s[5] + c[3] * c[5], ay = -s[3] * s[4];
    const double nz = s[4] * c[5], oz = -s[4] * s[5], az = c[4];
    /* In the vertical plane of the arm, then turned about the base axis. */
    const double C = c[2], S = s[2];
    const double nr = C * nx - S * nz, nh = S * nx + C * nz;
    const double or_ = C * ox - S * oz, oh = S * ox + C * oz;
    const double ar = C * ax - S * az, ah = S * ax + C * az;
    const double r = a2 * c[1] + a3 * C - d4 * S, h = a2 * s[1] + a3 * S + d4 * C;
    out[0] = c[0] * nr - s[0] * ny;
    out[1] = c[0] * or_ - s[0] * oy;
    out[2] = c[0] * ar - s[0] * ay;
    out[3] = c[0] * r + s[0] * d3;
    out[4] = s[0] * nr + c[0] * ny;
    out[5] = s[0] * or_ + c[0] * oy;
    out[6] = s[0] * ar + c[0] * ay;
    out[7] = s[0] * r - c[0] * d3;
    out[8] = nh;
    out[9] = oh;
    out[10] = ah;
    out[11] = h;
    out[12] = 0;
    out[13] = 0;
    out[14] = 0;
    out[15] = 1;
}
