/* When a step along a load case is accepted, of both marches: the constants of march.py and newton.py. */
#define HISTORY 4
#define PREDICTION_SHARE 0.1    /* of the predicted step */
#define SMOOTH 0.03
#define GROWTH 2.0
#define CORNER_DISTANCE 0.5     /* mm */
#define NEGLIGIBLE_DISTANCE 0.02        /* mm */
#define RETURN 0.01
#define SLIP 2e-3               /* mm */
#define ONWARD 1e-3
#define STALL_LEVEL 1e-4        /* N: rounding of very stiff parts keeps the residual from falling below */
#define STALL_STEP 1e-10        /* mm, Gibbs units: a step that no longer moves anything */
