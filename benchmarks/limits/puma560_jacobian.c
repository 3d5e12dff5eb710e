/* By hand: q1..q6, a2, a3, d3, d4 in; (v; omega) of the wrist centre, row by row, out. */
enum { ANGLES = 5 };

static inline void angles_of(const double *in, double *angles)
{
    angles[0] = in[0];
    angles[1] = in[1];
    angles[2] = in[1] + in[2];
    angles[3] = in[3];
    angles[4] = in[4];
}

static inline void body(const double *in, const double *s, const double *c, double *out)
{
    const double a2 = in[6], a3 = in[7], d3 = in[8], d4 = in[9];
    const double C1 = c[0], S1 = s[0], C = c[2], S = s[2];
    const double fr = a3 * C - d4 * S, fh = a3 * S + d4 * C; /* the forearm: out and up */
    const double r = a2 * c[1] + fr, h = a2 * s[1] + fh;
    out[3] = out[4] = out[5] = out[9] = out[10] = out[11] = out[12] = 0;
    out[15] = out[16] = out[17] = out[18] = out[24] = out[31] = out[32] = 0;
    out[0] = d3 * C1 - S1 * r;
    out[1] = -C1 * h;
    out[2] = -C1 * fh;
    out[6] = C1 * r + d3 * S1;
    out[7] = -S1 * h;
    out[8] = -S1 * fh;
    out[13] = r;
    out[14] = fr;
    out[19] = S1;
    out[20] = S1;
    out[25] = -C1;
    out[26] = -C1;
    out[30] = 1;
    /* Axis 4 lies along the forearm, axis 5 across it, axis 6 is the hand's. */
    out[21] = -C1 * S;
    out[27] = -S1 * S;
    out[33] = C;
    out[22] = C1 * C * s[3] + S1 * c[3];
    out[28] = S1 * C * s[3] - C1 * c[3];
    out[34] = S * s[3];
    const double ax = -c[3] * s[4], ay = -s[3] * s[4];
    const double ar = C * ax - S * c[4];
    out[23] = C1 * ar - S1 * ay;
    out[29] = S1 * ar + C1 * ay;
    out[35] = S * ax + C * c[4];
}
