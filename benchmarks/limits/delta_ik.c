/* By hand: x, y, z, f, e, L, l and the directions of the legs in; all eight branches out. Leaves out
 * the test of the input, and NaN is all that it says of a branch that does not exist. */
enum { ANGLES = 3 };

static inline void angles_of(const double *in, double *angles)
{
    for (int k = 0; k < 3; ++k) angles[k] = in[7 + k];
}

/* The law of cosines for the crank: K is how far along the reach it ends, H how far beside. */
static inline void leg(const double *in, double s, double c, double *y, double *x)
{
    const double a = c * in[0] + s * in[1] + in[4] - in[3], b = -in[2], L = in[5];
    const double aside = s * in[0] - c * in[1], square = a * a + b * b;
    const double K = square + L * L - (in[6] - aside) * (in[6] + aside);
    const double H = cf_sqrt(4 * L * L * square - K * K);
    y[0] = b * K - a * H;
    x[0] = a * K + b * H;
    y[3] = b * K + a * H;
    x[3] = a * K - b * H;
}

static inline void body(const double *in, const double *s, const double *c, double *out)
{
    double ys[8] = { 0 }, xs[8] = { 0 }, t[8];
    leg(in, s[0], c[0], ys, xs);
    leg(in, s[1], c[1], ys + 1, xs + 1);
    leg(in, s[2], c[2], ys + 2, xs + 2);
    ARCTANGENTS(6, 8, ys, xs, t);
    out[0] = out[3] = out[6] = out[9] = t[0];
    out[12] = out[15] = out[18] = out[21] = t[3];
    out[1] = out[4] = out[13] = out[16] = t[1];
    out[7] = out[10] = out[19] = out[22] = t[4];
    out[2] = out[8] = out[14] = out[20] = t[2];
    out[5] = out[11] = out[17] = out[23] = t[5];
}
