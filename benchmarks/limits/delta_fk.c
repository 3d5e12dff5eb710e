/* By hand: the joints, f, e, L, l and the directions of the legs in; both modes out, the centre of the
 * circle through the elbows and a step at right angles to it. No test of the input, no status, and
 * digits are lost where the elbows are nearly in line. */
enum { ANGLES = 6 };

static inline void angles_of(const double *in, double *angles)
{
    for (int k = 0; k < 3; ++k) angles[k] = in[k], angles[k + 3] = in[7 + k];
}

static inline void body(const double *in, const double *s, const double *c, double *out)
{
    const double arm = in[3] - in[4], L = in[5], l = in[6];
    const double r1 = arm + L * c[0], r2 = arm + L * c[1], r3 = arm + L * c[2];
    const double x1 = r1 * c[3], y1 = r1 * s[3], z1 = -L * s[0];
    const double ux = r2 * c[4] - x1, uy = r2 * s[4] - y1, uz = -L * s[1] - z1;
    const double vx = r3 * c[5] - x1, vy = r3 * s[5] - y1, vz = -L * s[2] - z1;
    const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const double uu = ux * ux + uy * uy + uz * uz, vv = vx * vx + vy * vy + vz * vz;
    const double share = 1 / (nx * nx + ny * ny + nz * nz), half = share / 2;
    const double wx = uu * vx - vv * ux, wy = uu * vy - vv * uy, wz = uu * vz - vv * uz;
    const double cx = half * (wy * nz - wz * ny), cy = half * (wz * nx - wx * nz);
    const double cz = half * (wx * ny - wy * nx);
    const double h = cf_sqrt((l * l - cx * cx - cy * cy - cz * cz) * share);
    out[0] = x1 + cx - h * nx;
    out[1] = y1 + cy - h * ny;
    out[2] = z1 + cz - h * nz;
    out[3] = x1 + cx + h * nx;
    out[4] = y1 + cy + h * ny;
    out[5] = z1 + cz + h * nz;
}
