/* The constants of the two types. The polynomials come from the Remez algorithm in 260 bits, which
 * minimises the relative error of the function; the coefficients were then rounded one after another.
 * They are odd or even in the argument; z is its square:
 *   sin r = r + r z S(z),  cos r = 1 + z (-1/2 + z C(z))  on |r| <= pi/4;
 *   atan t = t + t z A(z)  on 0 <= t <= 1.
 * Cody-Waite: pi/2 = CF_PIO2_1 + _2 + _3, all positive. With |n| <= 2^K, the first two have
 * p - K bits (p is the precision), so their products with n are exact. The third is rounded: an error
 * of n 2^(2K-3p), against a remainder of at least 2^-60.5 (float: 2^-26.3). Over all n below the limit
 * that error is at most 0.04 ulp for K = 18 (float: 0.02 for K = 7); one more bit would make it
 * 2.1 (0.35) ulp. */
#ifdef CLOSEDFORM_FLOAT

#define CF_TRIG_LIMIT CLOSEDFORM_C(200.0)
#define CF_PIO2_1 CLOSEDFORM_C(1.5707855224609375)
#define CF_PIO2_2 CLOSEDFORM_C(1.0804273188114166e-05)
#define CF_PIO2_3 CLOSEDFORM_C(6.07710062827671e-11)
#define CF_ROUND CLOSEDFORM_C(8388608.0) /* 2^23 */
#define CF_BELOW_PI CLOSEDFORM_C(3.1415925) /* the largest float below pi: CF_PI is above it */
#define CF_PIO2_LO CLOSEDFORM_C(-4.371139e-8)
#define CF_TWO_PI_LO CLOSEDFORM_C(-1.7484555e-7)

/* relative error of sin 2^-27.9, of cos 2^-33.0, of atan 2^-27.2 */
CF_INLINE real_t cf_sin_poly(real_t one, real_t z)
{
    return -0.166666552f + z * (0.00833218731f + z * -0.00019517896f * one) * one;
}

CF_INLINE real_t cf_cos_poly(real_t one, real_t z)
{
    return 0.0416666456f + z * (-0.00138873095f + z * 2.44323292e-5f * one) * one;
}

CF_INLINE real_t cf_atan_poly(real_t z)
{
    const real_t z2 = z * z, z4 = z2 * z2;
    const real_t a0 = (-0.333332986f + z * 0.199985296f) +
                      z2 * (-0.142640144f + z * 0.109508604f);
    const real_t a4 = (-0.0839920342f + z * 0.0578787364f) +
                      z2 * (-0.031093346f + z * 0.0108661409f);
    return a0 + z4 * (a4 + z4 * -0.00178210891f);
}

#else

#define CF_TRIG_LIMIT CLOSEDFORM_C(400000.0)
#define CF_PIO2_1 CLOSEDFORM_C(1.5707963267923333)
#define CF_PIO2_2 CLOSEDFORM_C(2.5633441515839558e-12)
#define CF_PIO2_3 CLOSEDFORM_C(1.0562999066987428e-23)
#define CF_ROUND CLOSEDFORM_C(4503599627370496.0) /* 2^52 */
#define CF_BELOW_PI CF_PI
#define CF_PIO2_LO CLOSEDFORM_C(6.123233995736766e-17)
#define CF_TWO_PI_LO CLOSEDFORM_C(2.4492935982947064e-16)

/* relative error of sin 2^-57.8, of cos 2^-63.9, of atan 2^-56.7 */
CF_INLINE real_t cf_sin_poly(real_t one, real_t z)
{
    const real_t z2 = z * z;
    return (-0.1666666666666663 + z * 0.008333333333321842 * one) +
           z2 * ((-0.00019841269829360994 + z * 2.7557313539658054e-06 * one) +
                 z2 * (-2.5050734577586117e-08 + z * 1.5895442710921173e-10 * one) * one) * one;
}

CF_INLINE real_t cf_cos_poly(real_t one, real_t z)
{
    const real_t z2 = z * z;
    return (0.041666666666666595 + z * -0.0013888888888873342 * one) +
           z2 * ((2.4801587289002127e-05 + z * -2.7557314217063467e-07 * one) +
                 z2 * (2.087570540007036e-09 + z * -1.1358749458908495e-11 * one) * one) * one;
}

CF_INLINE real_t cf_atan_poly(real_t z)
{
    const real_t z2 = z * z, z4 = z2 * z2, z8 = z4 * z4;
    const real_t a0 = (-0.33333333333333071 + z * 0.19999999999951748) +
                      z2 * (-0.14285714282587961 + z * 0.11111111007337657);
    const real_t a4 = (-0.090909070077165921 + z * 0.076922798879409296) +
                      z2 * (-0.066664044155228114 + z * 0.058805297635777999);
    const real_t a8 = (-0.052535265964409404 + z * 0.047223477926983198) +
                      z2 * (-0.042192422592310305 + z * 0.036643136902368242);
    const real_t a12 = (-0.029905716796308757 + z * 0.021987046853392127) +
                       z2 * (-0.013902553426051959 + z * 0.0071978698112242813);
    const real_t a16 = (-0.0028856017598414704 + z * 0.00083155685524330175) +
                       z2 * (-0.00015221055130022849 + z * 1.3229941982294489e-5);
    return (a0 + z4 * a4) + z8 * ((a8 + z4 * a12) + z8 * a16);
}

#endif

/* The nearest integer; x may be negative. */
CF_INLINE real_t cf_nearest(real_t x)
{
    const real_t shift = CLOSEDFORM_C(1.5) * CF_ROUND;
    return (x + shift) - shift;
}

/* Sine and cosine for |x| <= CF_TRIG_LIMIT, without a branch. The values are unspecified for larger
 * |x| and for NaN: use cf_sincos_block, or test with cf_trig_excess. If `one` is cf_one(), every
 * product is rounded, and sincos_as_in_c of the NumPy modules gives the same bits. */
CF_INLINE void cf_sincos_rounded(real_t one, real_t x, real_t *s, real_t *c)
{
    const real_t ax = cf_abs(x);
    /* Adding CF_ROUND rounds to an integer and puts its low bits at the end of the word. */
    const real_t shifted = ax * CLOSEDFORM_C(0.6366197723675814) * one + CF_ROUND;
    const real_t n = shifted - CF_ROUND;
    const cf_word quadrant = cf_to_word(shifted);

    /* ax - n pi/2 = r + tail. r1 and the rounding error of r are exact. */
    const real_t r1 = ax - n * CF_PIO2_1;
    const real_t r = r1 - n * CF_PIO2_2;
    const real_t tail = ((r1 - r) - n * CF_PIO2_2) - n * CF_PIO2_3 * one;

    const real_t z = r * r;
    const real_t half = CLOSEDFORM_C(0.5);
    const real_t sin_r = r + ((r * z) * cf_sin_poly(one, z) * one + tail * (1 - half * z) * one);
    const real_t cos_r = 1 + (z * (z * cf_cos_poly(one, z) * one - half) * one - r * tail * one);

    const cf_word sw = cf_to_word(sin_r), cw = cf_to_word(cos_r);
    const cf_word swap = (sw ^ cw) & ((cf_word)0 - (quadrant & 1u));
    const cf_word s_sign = (quadrant & 2u) << (CF_TOP_BIT - 1u);
    const cf_word c_sign = ((quadrant + 1u) & 2u) << (CF_TOP_BIT - 1u);
    *s = cf_from_word(sw ^ swap ^ s_sign ^ (cf_to_word(x) & CF_SIGN));
    *c = cf_from_word(cw ^ swap ^ c_sign);
}

CF_INLINE void cf_sincos(real_t x, real_t *s, real_t *c)
{
    cf_sincos_rounded(CLOSEDFORM_C(1.0), x, s, c);
}

/* A word with its sign bit set if |x| > CF_TRIG_LIMIT or x is NaN; a loop ORs those of its lanes. */
CF_INLINE cf_word cf_trig_excess(real_t x)
{
    return cf_to_word(CF_TRIG_LIMIT) - (cf_to_word(x) & ~CF_SIGN);
}

/* Copies 1, 2, 4 or 8 numbers as one vector. If they were written one by one and read as one vector,
 * the processor would wait until the last of them had reached the cache. */
#if defined(__GNUC__)
typedef real_t cf_lanes2 __attribute__((vector_size(2 * sizeof(real_t))));
typedef real_t cf_lanes4 __attribute__((vector_size(4 * sizeof(real_t))));
typedef real_t cf_lanes8 __attribute__((vector_size(8 * sizeof(real_t))));

CF_INLINE void cf_side_by_side(size_t n, const real_t *x, real_t *lanes)
{
    if (n == 1) {
        lanes[0] = x[0];
    } else if (n == 2) {
        const cf_lanes2 all = { x[0], x[1] };
        memcpy(lanes, &all, sizeof all);
    } else if (n == 4) {
        const cf_lanes4 all = { x[0], x[1], x[2], x[3] };
        memcpy(lanes, &all, sizeof all);
    } else {
        const cf_lanes8 all = { x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7] };
        memcpy(lanes, &all, sizeof all);
    }
}
#else
CF_INLINE void cf_side_by_side(size_t n, const real_t *x, real_t *lanes)
{
    memcpy(lanes, x, n * sizeof *x);
}
#endif

/* Recomputes with libm the lanes that cf_sincos does not cover. */
CF_RARE void cf_sincos_fixup(size_t n, const real_t *x, real_t *s, real_t *c)
{
    for (size_t i = 0; i < n; ++i) {
        if (cf_trig_excess(x[i]) & CF_SIGN) {
            s[i] = CF_LIBM(sin)(x[i]);
            c[i] = CF_LIBM(cos)(x[i]);
        }
    }
}

/* Sine and cosine of any n angles; the arrays must not overlap. */
CF_INLINE void cf_sincos_block_rounded(size_t n, real_t one, const real_t *CF_RESTRICT x,
                                       real_t *CF_RESTRICT s, real_t *CF_RESTRICT c)
{
    cf_word excess = 0;
    for (size_t i = 0; i < n; ++i) {
        cf_sincos_rounded(one, x[i], &s[i], &c[i]);
        excess |= cf_trig_excess(x[i]);
    }
    if (excess & CF_SIGN) cf_sincos_fixup(n, x, s, c);
}

CF_INLINE void cf_sincos_block(size_t n, const real_t *CF_RESTRICT x, real_t *CF_RESTRICT s,
                               real_t *CF_RESTRICT c)
{
    cf_sincos_block_rounded(n, CLOSEDFORM_C(1.0), x, s, c);
}

/* Recomputes with libm the angles beyond CF_TRIG_LIMIT. */
CF_RARE void cf_principal_fixup(size_t n, const real_t *x, real_t *angle)
{
    for (size_t i = 0; i < n; ++i) {
        if (cf_trig_excess(x[i]) & CF_SIGN)
            angle[i] = CF_LIBM(atan2)(CF_LIBM(sin)(x[i]), CF_LIBM(cos)(x[i]));
    }
}

/* An angle with |x| <= CF_TRIG_LIMIT, moved to [-pi, pi] by whole turns, up to rounding. */
CF_INLINE real_t cf_principal(real_t x)
{
    const real_t n4 = 4 * cf_nearest(x * CLOSEDFORM_C(0.15915494309189535));
    return ((x - n4 * CF_PIO2_1) - n4 * CF_PIO2_2) - n4 * CF_PIO2_3;
}

/* The same for any n angles; the arrays must not overlap. */
CF_INLINE void cf_principal_block(size_t n, const real_t *CF_RESTRICT x, real_t *CF_RESTRICT angle)
{
    cf_word excess = 0;
    for (size_t i = 0; i < n; ++i) {
        angle[i] = cf_principal(x[i]);
        excess |= cf_trig_excess(x[i]);
    }
    if (excess & CF_SIGN) cf_principal_fixup(n, x, angle);
}

/* Sine and cosine of the n angles of one call; n is a constant: 1, 2, 4 or a multiple of 8. The
 * compiler makes vectors of them, and eight cost little more than one. */
CF_INLINE void cf_sincos_lanes_rounded(size_t n, real_t one, const real_t *x, real_t *s, real_t *c)
{
    const size_t width = n < 8 ? n : 8;
    for (size_t k = 0; k < n; k += width) {
        real_t angles[8];
        cf_side_by_side(width, x + k, angles);
        cf_sincos_block_rounded(width, one, angles, s + k, c + k);
    }
}

CF_INLINE void cf_sincos_lanes(size_t n, const real_t *x, real_t *s, real_t *c)
{
    cf_sincos_lanes_rounded(n, CLOSEDFORM_C(1.0), x, s, c);
}

/* The same, with the angles also moved to [-pi, pi] as by cf_principal. */
CF_INLINE void cf_turned_lanes_rounded(size_t n, real_t one, const real_t *x, real_t *s, real_t *c,
                                       real_t *turned)
{
    const size_t width = n < 8 ? n : 8;
    for (size_t k = 0; k < n; k += width) {
        real_t angles[8];
        cf_side_by_side(width, x + k, angles);
        cf_word excess = 0;
        for (size_t i = 0; i < width; ++i) {
            cf_sincos_rounded(one, angles[i], &s[k + i], &c[k + i]);
            turned[k + i] = cf_principal(angles[i]);
            excess |= cf_trig_excess(angles[i]);
        }
        if (excess & CF_SIGN) {
            cf_sincos_fixup(width, angles, s + k, c + k);
            cf_principal_fixup(width, angles, turned + k);
        }
    }
}

CF_INLINE void cf_turned_lanes(size_t n, const real_t *x, real_t *s, real_t *c, real_t *turned)
{
    cf_turned_lanes_rounded(n, CLOSEDFORM_C(1.0), x, s, c, turned);
}

/* C99 atan2 in [-CF_PI, CF_PI], including signed zeros, infinities and NaN, with one division and no
 * branch. The quotient never exceeds 1, so no argument is too large or too small. */
CF_INLINE real_t cf_atan2(real_t y, real_t x)
{
    const real_t ax = cf_abs(x), ay = cf_abs(y);
    /* If an argument is NaN, so is one of these, because cf_min and cf_max return their second
     * argument then. 0/0 would raise an exception, so it is not computed; inf/inf counts as 1. */
    const real_t num = cf_min(ay, ax), larger = cf_max(ax, ay);
    const real_t den = larger == 0 ? CLOSEDFORM_C(1) : larger;
    const real_t t = num == den ? CLOSEDFORM_C(1) : num / den;
    const real_t z = t * t;
    const real_t a = t + t * (z * cf_atan_poly(z));

    /* The angle is 0, pi/2 or pi, plus or minus a. */
    const real_t side = cf_copysign(1, x);
    const real_t right_angles = ay > ax ? CLOSEDFORM_C(1) : 1 - side;
    const real_t offset = ay > ax ? -side * a : side * a;
    const real_t high = right_angles * (CF_PI / 2);
    return cf_copysign(high + (offset + right_angles * CF_PIO2_LO), y);
}

/* atan2 of the n pairs of one call; n is a constant: 2, 4 or a multiple of 8. */
CF_INLINE void cf_atan2_lanes(size_t n, const real_t *y, const real_t *x, real_t *angle)
{
    const size_t width = n < 8 ? n : 8;
    for (size_t k = 0; k < n; k += width) {
        real_t ys[8], xs[8];
        cf_side_by_side(width, y + k, ys);
        cf_side_by_side(width, x + k, xs);
        for (size_t i = 0; i < width; ++i)
            angle[k + i] = cf_atan2(ys[i], xs[i]);
    }
}

/* An angle in [-CF_PI, CF_PI], the range of cf_atan2, moved to (-CF_PI, CF_PI]. */
CF_INLINE real_t cf_wrap_cut(real_t angle) { return angle <= -CF_PI ? CF_PI : angle; }

/* The sum of a few angles, moved to (-CF_PI, CF_PI]; a sum that is already there does not change. */
CF_INLINE real_t cf_wrap(real_t angle)
{
    const real_t turns = cf_nearest(angle * CLOSEDFORM_C(0.15915494309189535));
    const real_t a = (angle - turns * (2 * CF_PI)) - turns * CF_TWO_PI_LO;
    const real_t down = (a - 2 * CF_PI) - CF_TWO_PI_LO;
    return cf_wrap_cut(a > CF_BELOW_PI ? down : a);
}
