/* By hand: x, y, l1, l2 in; both branches out, no test of the input. */
enum { ANGLES = 0 };

static inline void angles_of(const double *in, double *angles) {}

static inline void body(const double *in, const double *s, const double *c, double *out)
{
    const double x = in[0], y = in[1], a = in[2], b = in[3];
    const double r = cf_sqrt(x * x + y * y);
    const double p = (a + b - r) * (a + b + r), m = (r - a + b) * (r + a - b);
    const double u = cf_sqrt(cf_max(p, 0.0)), v = cf_sqrt(cf_max(m, 0.0));
    const double w = cf_sqrt(cf_max((a + b - r) * (r - a + b), 0.0));
    const double k = cf_sqrt((a + b + r) * cf_max(r + a - b, 0.0));
    const double ys[4] = { y, w, u, 0.0 }, xs[4] = { x, k, v, 1.0 };
    double t[4];
    ARCTANGENTS(3, 4, ys, xs, t);
    out[0] = cf_wrap(t[0] - 2 * t[1]);
    out[1] = 2 * t[2];
    out[2] = cf_wrap(t[0] + 2 * t[1]);
    out[3] = -2 * t[2];
}
