/* By hand: x, y, z, L0, L1, L2 in; all eight branches out, no test of the input. Five arctangents do,
 * because turning by half a turn about the axis mirrors the legs. */
enum { ANGLES = 0 };

static inline void angles_of(const double *in, double *angles) {}

static inline void body(const double *in, const double *s, const double *c, double *out)
{
    const double x = in[0], y = in[1], z = in[2], L0 = in[3], L1 = in[4], L2 = in[5];
    const double sum = L1 + L2, difference = L1 - L2, v = y - L0;
    const double square = x * x + z * z, r = cf_sqrt(square);
    const double C = square + y * y, D = square + v * v;
    const double Nc = cf_max(sum * sum - C, 0.0), Mc = cf_max(C - difference * difference, 0.0);
    const double Nd = cf_max(sum * sum - D, 0.0), Md = cf_max(D - difference * difference, 0.0);
    const double ac = Mc * sum + Nc * difference, bc = 2 * L2 * cf_sqrt(Mc * Nc);
    const double ad = Md * sum + Nd * difference, bd = 2 * L2 * cf_sqrt(Md * Nd);
    const double ys[8] = {
        z, ac * r - bc * y, ac * r + bc * y, ad * r - bd * v, ad * r + bd * v, 0.0, 0.0, 0.0
    };
    const double xs[8] = {
        -x, ac * y + bc * r, ac * y - bc * r, ad * v + bd * r, ad * v - bd * r, 1.0, 1.0, 1.0
    };
    double t[8];
    ARCTANGENTS(5, 8, ys, xs, t);
    const double turned = t[0] > 0 ? t[0] - CF_PI : t[0] + CF_PI;
    const double c1 = cf_wrap_cut(-t[1]), c2 = cf_wrap_cut(-t[2]);
    const double d1 = cf_wrap_cut(-t[3]), d2 = cf_wrap_cut(-t[4]);
    out[0] = out[3] = out[6] = out[9] = t[0];
    out[12] = out[15] = out[18] = out[21] = turned;
    out[1] = out[4] = t[1];
    out[7] = out[10] = t[2];
    out[2] = out[8] = t[3];
    out[5] = out[11] = t[4];
    out[13] = out[16] = c2;
    out[19] = out[22] = c1;
    out[14] = out[20] = d2;
    out[17] = out[23] = d1;
}
