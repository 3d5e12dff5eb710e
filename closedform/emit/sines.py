"""The constants of the sine and cosine in double precision, for both C and NumPy.

A status that depends on a sine is the same in both only if the sine is the same to the last bit.
``closedform.h`` says how the constants were computed.
"""

LIMIT = 400000.0
"""The largest angle that is reduced with ``RIGHT_ANGLE``."""
RIGHT_ANGLES = 0.6366197723675814
"""2/pi."""
RIGHT_ANGLE = (1.5707963267923333, 2.5633441515839558e-12, 1.0562999066987428e-23)
"""pi/2 in three parts; a multiple of either of the first two is exact."""
ROUND = 4503599627370496.0
"""Adding this constant rounds to an integer."""
SINE = (
    -0.1666666666666663,
    0.0083333333333218424,
    -0.00019841269829360994,
    2.7557313539658054e-6,
    -2.5050734577586117e-8,
    1.5895442710921173e-10,
)
COSINE = (
    0.041666666666666595,
    -0.0013888888888873342,
    2.4801587289002127e-5,
    -2.7557314217063467e-7,
    2.087570540007036e-9,
    -1.1358749458908495e-11,
)
