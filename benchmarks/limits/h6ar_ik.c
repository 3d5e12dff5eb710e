/* By hand: x, y, z, psi, phi, pitch, L1, L2, a3, d1, d, gs, al, loff, lp in; all four branches out, no
 * test of the input. Where the waist faces backwards the arm is the mirror image of the one with the
 * other elbow; only the arms' angles to the wrist, alpha and beta, differ in all four. */
enum { ANGLES = 3 };

static inline void angles_of(const double *in, double *angles)
{
    angles[0] = in[3];
    angles[1] = in[4];
    angles[2] = in[5];
}

/* The sides of alpha and beta, opposite and adjacent, from the direction of the upper arm. */
static inline void sides(double c, double s, double v1, double v2, double ahead, double higher,
    double L1, double *y, double *x)
{
    const double whole = cf_abs(v1), p1 = cf_copysign(1.0, v1) * (ahead * c + higher * s);
    const double p2 = higher * c - ahead * s;
    const double along = p2 - v2 * (p1 / whole);
    y[0] = along;
    x[0] = cf_sqrt(cf_max((L1 - along) * (L1 + along), 0.0));
    y[1] = p1;
    x[1] = cf_sqrt(cf_max((whole - p1) * (whole + p1), 0.0));
}

static inline void body(const double *in, const double *s, const double *c, double *out)
{
    const double x = in[0], y = in[1], v = in[2] - in[9];
    const double L1 = in[6], L2 = in[7], a3 = in[8], d = in[10], gs = in[11], al = in[12];
    const double secant = 1 / c[0], lp = in[14];
    const double near = (al + gs) * c[0] - d, far = d + (al - gs) * c[0];
    const double reach = in[13] + lp * c[2] + cf_sqrt(near * far) * secant;
    const double ahead = d * s[0] * secant, higher = d * s[1] / c[1];
    const double across = reach * s[0];
    const double side = across * c[1] - lp * s[2] * s[1];
    const double up_W = L2 + reach * c[0], out_W = a3 + lp * s[2] * c[1] + across * s[1];
    const double square_W = up_W * up_W + out_W * out_W, fore = cf_sqrt(square_W);
    const double h = cf_sqrt(x * x + y * y), below = h - side, above = h + side;
    const double r2 = below * above, r = cf_sqrt(r2), square = r2 + v * v;
    const double N = (L1 + fore) * (L1 + fore) - square, M = square - (L1 - fore) * (L1 - fore);
    const double root = cf_sqrt(N * M), share = 1 / (M + N);
    const double cb = (M - N) * share, sb = 2 * root * share;
    /* fore times the bend plus the lag: of the elbow to one side and to the other */
    const double c_p = cb * out_W - sb * up_W, s_p = cb * up_W + sb * out_W;
    const double c_m = cb * out_W + sb * up_W, s_m = cb * up_W - sb * out_W;
    const double inverse = 1 / fore;
    const double v1_p = (L2 * c_p - a3 * s_p) * inverse, v2_p = (L2 * s_p + a3 * c_p) * inverse;
    const double v1_m = (L2 * c_m - a3 * s_m) * inverse, v2_m = (L2 * s_m + a3 * c_m) * inverse;
    const double forward = L1 + fore * cb, aside = fore * sb, scale = 1 / square;
    const double out_m = forward * r - aside * v, up_m = forward * v + aside * r;
    const double out_p = forward * r + aside * v, up_p = forward * v - aside * r;
    double ys[16] = { -x, r, up_m, up_p, 2 * root, up_W };
    double xs[16] = { y, side, out_m, out_p, M - N, out_W };
    const double co_m = out_m * scale, su_m = up_m * scale;
    const double co_p = out_p * scale, su_p = up_p * scale;
    sides(co_m, su_m, v1_m, v2_m, ahead, higher, L1, ys + 6, xs + 6);
    sides(co_p, su_p, v1_p, v2_p, ahead, higher, L1, ys + 8, xs + 8);
    sides(-co_m, su_m, v1_p, v2_p, ahead, higher, L1, ys + 10, xs + 10);
    sides(-co_p, su_p, v1_m, v2_m, ahead, higher, L1, ys + 12, xs + 12);
    ys[14] = ys[15] = 0;
    xs[14] = xs[15] = 1;
    double t[16];
    ARCTANGENTS(14, 16, ys, xs, t);
    const double bend_m = t[5] - t[4], bend_p = t[5] + t[4];
    const double mirrored_m = CF_PI - t[2], mirrored_p = CF_PI - t[3];
    double q[24] = {
        t[0] + t[1], t[2] + t[6], bend_m - t[6] + t[7], t[2] - t[6], bend_m + t[6] - t[7], in[5],
        t[3] + t[8], bend_p - t[8] + t[9], t[3] - t[8], bend_p + t[8] - t[9],
        t[0] - t[1], mirrored_m + t[10], bend_p - t[10] + t[11],
        mirrored_m - t[10], bend_p + t[10] - t[11],
        mirrored_p + t[12], bend_m - t[12] + t[13], mirrored_p - t[12], bend_m + t[12] - t[13]
    };
    WRAPPED(19, 24, q);
    out[0] = out[6] = q[0];
    out[12] = out[18] = q[10];
    out[5] = out[11] = out[17] = out[23] = q[5];
    out[1] = q[1];
    out[2] = q[2];
    out[3] = q[3];
    out[4] = q[4];
    out[7] = q[6];
    out[8] = q[7];
    out[9] = q[8];
    out[10] = q[9];
    out[13] = q[11];
    out[14] = q[12];
    out[15] = q[13];
    out[16] = q[14];
    out[19] = q[15];
    out[20] = q[16];
    out[21] = q[17];
    out[22] = q[18];
}
