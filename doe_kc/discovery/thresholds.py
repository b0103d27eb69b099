"""The numbers by which discovery decides, in the order of its steps.

Each is followed by its unit and what it decides, then where it comes from: statistics, the accuracy of rigs
and benches, or a choice, and then what speaks for it. `docs/thresholds.md` prints them.
"""

from __future__ import annotations

# Data: errors beside the rig's noise

INPUT_GAIN = 0.003
"""-, standard deviation of the scale of a rig's input. Accuracy class of its load cells, travel and angle
sensors."""
NOISE_SIZE_DOUBT = 0.2
"""-, share added to every variance of a map. Few repeats leave the noise's own size open: three of them by a
fifth."""
NOISE_SD_SHARE = 0.02
"""-, standard deviation of the noise's own size in a prediction. Taken from three runs of every load case."""
TRACE_SD = 0.03
"""typical sizes, standard deviation of the trace of an effect that is not in the model, and mean of that of a
rack's mount. Every car has some of each; `RELEVANT` is 3.3 of it, so that fewer than one trace in a thousand
is large enough for a name."""

TRACE_SEEN = 0.1
"""standard deviations of the records, below which a trace is left out. It moves nothing."""

SIDE_POSITION = 0.25
"""mm, standard deviation of right minus left of a hardpoint. Tolerance of drilled and welded parts."""
SIDE_CLEARANCE = 1.0
"""mm, standard deviation of right minus left of a bump stop's clearance. Rubber and spring seats of one
batch."""
SIDE_ANGLE = 0.07
"""deg, standard deviation of right minus left of a static angle. Setting on an alignment bench."""
SIDE_BUSHING = 0.03
"""-, standard deviation of right minus left of a bushing's stiffness, relative. Rubber of one batch."""
SIDE_RATE = 0.02
"""-, standard deviation of right minus left of a rate, relative. Springs are paired by rate."""
COMMON_SHARE = 0.25
"""-, share of the variance of a car's parameters that all measured cars are taken to have in common at least.
A choice: a series is off its axle file by half of what one car is, by tools, batches of rubber, another stage
of the drawings."""
SCATTER_LOG_SD = 1.0
"""-, standard deviation of the logarithm of a group's scatter over what the bounds leave to it, before the
records. A factor of 2.7: parts of a series are better than their bounds, or an axle file is worse. At 0.5 the
standard deviations of 42 sizes of open cars were 4 % wider, and the sizes no better."""

# Fit

FIT_DECREASE = 0.02
"""ln likelihood times 2, predicted decrease below which a fit is ended. A seventh of a standard deviation:
less than any decision turns on."""
LAST_STEP_DECREASE = 1.0
"""ln likelihood times 2, predicted decrease below which a step is the last and keeps the derivatives before
it. One standard deviation; the quadratic convergence of Gauss-Newton leaves a hundredth of it."""
FRESH_DECREASE = 3.0
"""ln likelihood times 2, decrease since derivatives were taken up to which they may end a fit. Less than
two standard deviations, over which derivatives hardly change: on a car with one effect 0.3 and 30 gave the
same verdict and sizes to 0.1 %."""
REUSE_DECREASE = 3000.0
"""ln likelihood times 2, decrease below which old derivatives still lead on. On a car with
one effect the sizes were the same to 0.1 % with fresh derivatives at every step (0), and from 300 to 30 000,
at the same time within a tenth."""
HOPELESS_SHARE = 0.5
"""-, by which a fit is trusted to fall further than its whole Gauss-Newton step promises, else it is given
up where that is not enough, and by which the effects that another law asks for are trusted to bring more than
they promise. A choice: the first steps on a car with rubber brought 0.6 to 1.0 of theirs."""
BEYOND_DOUBT = 200.0
"""ln evidence, behind which a removal, a rival or another closed law of a friction need not be fitted to its
end. Four times what `NAME_ALWAYS_LEVEL` asks for; odds beyond a million are not told apart."""
FIT_STEPS = 24
"""-, steps of a fit at most. A fit that takes more is lost: on a car with one effect 12 were enough
for the same verdict and sizes."""
REFIT_STEPS = 8
"""-, steps of a refit with a load case held out at most. It begins close to where it ends."""
CHORD_STEPS = 6
"""-, steps along known derivatives at most. More would not end there."""
CHORD_DECREASE = 10.0
"""ln likelihood times 2, decrease up to which a load case held out is followed on known derivatives. At 30 an
RMS was off by 0.03, at 10 and at 3 by less than 0.001, at the same cost."""
FIT_POOR_RATIO = 0.25
"""-, decrease over its prediction, below which the trust radius shrinks. Usual (Conn, Gould, Toint 2000)."""
FIT_GOOD_RATIO = 0.75
"""-, decrease over its prediction, above which the trust radius grows. Usual (Conn, Gould, Toint 2000)."""
LEAST_STEP = 0.0001
"""of a parameter's range and of an effect's typical size, trust radius below which a fit is given up. Beyond
any use: on a car with one effect 0.001 and 0.00001 gave the same."""
LARGEST_RADIUS = 2.0
"""of a parameter's range and of an effect's typical size, trust radius at most. Beyond, no axle is linear; on
a car with one effect 0.7 and 6 gave the same verdict and sizes."""
AMPLITUDE_LIMIT = 2.0
"""times what is believed, amplitude that a fit does not go beyond. Room for the verdict to refuse what is too
large."""
NUISANCE_LIMIT = 6.0
"""standard deviations, nuisance that a fit does not go beyond. A fault of the rig so large is an effect of
its own."""
AMPLITUDE_STEP = 0.001
"""typical sizes, step of amplitudes for their derivatives, forward differences. Measured on five effects:
columns were off by 0.07 % at most, by 0.7 % at 0.01 and by 0.2 % at 0.00001."""
DIRECTION_STEP = 1e-08
"""typical sizes, step of amplitudes for the derivatives of the axle's numbers, from which those of the curves
follow exactly. Rounding is some millionths of them, a compliance that stands for none bends by a
ten-thousandth."""
SHARE_AT_BOUNDS = 0.05
"""-, share of the parameters at a bound from which wider ranges are tried. A single one is a tolerance, not a
series."""
BOUND_ROUNDING = 1e-09
"""-, share of a range within which a value is at its bound. Rounding."""
BOUND_FACTORS = (1.5, 2.0)
"""-, by how much wider ranges are tried. A choice: a series off nominal by more than that is another axle."""
BOUND_EVIDENCE = 7.0
"""ln evidence, from which wider ranges are taken. A thousand to one: all parameters change at once."""
LOOP_EVIDENCE = 2.3
"""ln evidence, from which the loops before the record are changed. Ten to one: a loop more takes its time."""

LOOPS_SURE = 50.0
"""ln evidence, from which the loops before the record are settled for the rest of the search. Ten standard
deviations: further effects change the size of a friction, not how the rig was run."""

# Map of disagreement

FALSE_ALARM_CHANCE = 0.05
"""-, chance that noise alone passes the threshold somewhere on the map. The usual level."""
NOISE_CHANCE = 0.01
"""-, chance of a map's largest disagreement below which noise does not explain it. A name must not rest on
one in twenty."""
NOISE_DRAWS = 1000
"""-, maps drawn to find that chance. The one in a hundred is known to a third."""
CONTRAST_SHARE = 0.0001
"""-, share of a contrast's square below which re-tuning absorbs it wholly. What is left is rounding of
derivatives."""
DISAGREEMENTS_LISTED = 8
"""-, disagreements that are listed. Room on a page."""

# Screening

PROBE = 0.3
"""typical sizes, first size at which an effect is solved for. Small enough to be nearly linear, large enough
to open a clearance."""
PROBE_FACTOR = 0.1
"""-, factor of the first size where the effect is not linear below it. A tenth brings it to 0.03
typical sizes, where effects that level off are still linear; on a car with one effect 0.3 and 0.03 gave the
same."""
SCREEN_STEPS = 4
"""-, steps of a screening at most. A ranking needs no more: the leaders are refitted."""
SCREEN_STEP_SHARES = (1.0, 0.5, 0.2, 0.05)
"""-, shares of a step, tried one after the other until one gains. Four solutions at most, down to a
twentieth; on a car with one effect the whole step alone, and seven shares down to a hundredth, gave the
same."""
HOPELESS = 1.0
"""ln likelihood, that a step must promise over the model without the effect. Less is what noise gives any
column."""
SCREEN_DECREASE = 0.1
"""ln likelihood times 2, decrease below which an amplitude is settled. A third of a standard deviation."""
NULL_SHARE = 1e-12
"""-, share of what all sizes of an effect do, in squares, that is nothing. Rounding."""
SHAPE_STARTS = (0.0, -2.0, 2.0)
"""prior standard deviations, starts of a shape. It does not exist where the effect is absent (Davies
1977)."""
RESCREENED_MOST = 6
"""-, hypotheses that are screened anew at a later step at most, those of the largest gain. Only the
first few are refitted: on a car with one effect 3 and 30 gave the same verdict, sizes and time, on one with
five what came in was the first of them each time."""
PROMISING = 1.0
"""ln evidence to first order, from which a hypothesis is screened anew at a later step. As `HOPELESS`."""
CHUNKS = 4
"""-, parts of a screening for each worker. Enough for an even load and a bar that moves."""

# Refits

REFITS_MOST = 5
"""-, hypotheses that are refitted at each step. Each costs a refit; on a car with one
effect 2, 3 and 10 gave the same verdict and sizes at the same time within a tenth."""
RIVAL_CORRELATION = 0.3
"""-, |correlation| of what two effects explain, from which they are rivals. Below, both would be needed."""
REFIT_SHARE = 0.2
"""-, share of what the best explains, by screened gain and by squared correlation, below which a hypothesis
is not refitted. In its refit it would have to win five times as much: on a car with one effect 0.5 and 0.05
gave the same verdict and sizes."""
PLACES_REFITTED = 2
"""-, places of the same effect that are refitted at most. So that one effect does not fill the list."""
ABSORBED_SHARE = 0.95
"""-, share that re-tuning absorbs, from which all such effects are refitted. Differences of large changes are
missed by a screening of first order in the parameters."""
OVERLOOKED_MOST = 6
"""-, such effects that are refitted at most, those of the largest gain. Each costs a
refit: on a car with one effect 2 and 18 gave the same verdict and sizes."""
BENT_SHARE = 0.33
"""-, share of the parameters that bounds hold back, from which refits begin at the nominal axle too. A
five-link car with damper friction and a wrong ride height had 0.70 there, at its best without effects."""
NOMINAL_REFITS = 3
"""-, effects that lead between the bounds, and as many that lead by screening, that are refitted from
there; then pairs. Each costs a refit. On three cars of five effects the ride height was third by screening
and fourth to seventh between the bounds, on the five-link car second there."""
LEADER_ROUNDS = 6
"""-, times that leaders are refitted, the next ones where those before gained nothing. A damper friction of a
twentieth of its typical size promised 692 of ln evidence in screening and lost 8 in its refit, three faults
of the rig 90 and lost 11, while a tyre compliance that promised 65 gained 82."""
TIED_EVIDENCE = 1.0
"""ln evidence, up to which two places are equally good. Less than one standard deviation."""
FALSE_ALARM = 0.01
"""-, chance that noise alone brings in any effect, at the limits of exclusion and among screenings that are
refitted. The usual level of one in a hundred, shared by the whole library (Bonferroni)."""
EFFECTS_ABSENT = 20.0
"""-, second parameter of the Beta prior of an effect's probability, the first is 1. One effect in 21 before
the records: a library of two dozen, of which a car has one or a few."""
ACCEPTED_ODDS = 4.6
"""ln posterior odds, from which an effect is taken into the set. A hundred to one: what comes in is pruned
later, what stays out is not looked at again in the step."""
PROPOSAL_MOVES = 12
"""-, moves to the most probable set to first order at most. Room for `EFFECTS_MOST` and
two exchanges."""
PROPOSAL_PAIRS = 6
"""-, effects of which pairs are proposed. Fifteen pairs beside each set: milliseconds."""
PROPOSAL_GAIN = 50.0
"""ln posterior odds to first order, that each effect of several added at once must bring. Ten standard
deviations: what is weaker waits for better derivatives."""
LAW_WINDOW = 10.0
"""ln evidence, that another set or law may be behind for its sizes to count. Occam's window (Madigan,
Raftery 1994)."""
FREE_SHAPE_LOSS = 10.0
"""ln likelihood, with priors, that frictions of free shape may cost before sizes are estimated beside the
laws that were chosen. As `LAW_WINDOW`: on a car with five effects they cost 1."""
FEW_CONTRASTS = 1.1
"""Mean square of the contrasts that remain, up to which single ones stand out of noise and not all: a law
that a member lacks. Noise alone, with the discrepancy of laws among the errors, leaves 0.4 to 0.9."""
FREE_TRAVELS = (0.7, 1.4)
"""times the travel of the backbone nearest to the law before, other starts of a friction of free shape. Its
sliders stand in ratios of 1.4 to 2.3, so that shares and travel move from one of them to the next."""
GRID_FACTORS = (0.55, 1.8)
"""times the travel of a free backbone, those of the same virgin curve by sliders elsewhere from which fits
begin. Three of four steps between its sliders, in ratios of 1.4 to 2.3, are shorter."""
SAME_OPTIMUM = 0.01
"""-, by which all sizes of two fits of a set differ at most that are at one optimum. A hundredth: shapes
apart, fits that end there agree to a thousandth."""
COMPLIANCE_FACTORS = (0.7, 1.4)
"""times a compliance beside a free play, those from which fits begin too. An optimum that was missed lay 1.35
times as far."""
NEAR_START = 0.5
"""prior standard deviations, within which a number is where another start would begin. Half of the distance
between two starts of rubber's spread."""
SERIES_RATIOS = (1.3, 1.7, 2.2)
"""times the limit of a friction and the spring beside it on a rigid mount, those on a compliance of the same
loops from which fits begin. A steering column of 2000 N/mm on mounts of the rack of 8700, 4900 and 3700 N/mm;
374 N of two stages on a ratio of 1.8 were 262 +- 6 N, where 389 N fit as well: found from 2.2 alone."""
NEAR_RATIO = 1.1
"""-, change of that ratio below which a fit is there already. From ratios of 1.3 to 2 fits of a friction of
two stages ended at the same 1.5."""
LARGER_SET_ODDS = 3.0
"""ln posterior odds, that the set with such a compliance may be behind for its sizes to count. One in twenty:
the usual level."""
EFFECTS_MOST = 10
"""-, effects, named ones and traces, after which the search ends. Real cars lack three to six; rubber in two
groups of bushings and a roll technique make them eight, and beside them come traces. With 6, two of 18 cars
of three to six effects ended unexplained, with 8 one of 24 that have rubber too: the last effect found and
not taken."""
MOST_STEPS = 20
"""-, steps after which the search ends although effects still come in and out. Twice the number of
effects."""
REMOVAL_FACTOR = 10.0
"""times the threshold of acceptance, beyond which a member is not tried without. It would come in again."""

# Laws

DISCREPANCY_SHARES = (0.0, 0.01, 0.02, 0.05, 0.1)
"""-, standard deviations of the discrepancy of a law, relative to what it makes of a curve, that are tried.
Above a tenth a law is another law."""
LINEAR_TO = 0.02
"""-, standard deviation of a compliance's stiffness, relative, where the records show no other law. Bearings
and bolted joints stiffen or soften by some percent from rest to full load; the shape of a curve tells a tenth
of that. Without it a hub that softens by 2.5 % was told 3.5 standard deviations too soft."""
CONSTANT_TO = 0.0003
"""-, standard deviation of a friction's force, relative. No seal or guide rubs the same along its whole
travel. Of 36 drawn strut frictions, told to 0.05 to 0.1 %, 78 % lay within one standard deviation without
it, 81 % with it, and 94 % with 0.001."""
OPTIMA_TO = 0.25
"""-, standard deviation of the logarithm of a shape along which the cost has several optima, `Size.starts`.
Of 61 drawn cars the spread of rubber's yield distances was off by 7 % or less in two of three, told to 3 %,
and by more than half in five, where fits ended at another optimum than the car's."""
LAW_OPEN = 0.035
"""-, least share of the discrepancy of a compliance's law by which sizes beside it may shift. A joint that is
up to 15 % stiffer or softer under full load than at rest, all alike likely, leaves the middle of its law by
2.5 % (rms), which is 0.71 of the share. The 15 % are a guess of what bushings and bearings do."""
DISCREPANCY_LENGTH = 0.5
"""amplitudes, correlation length of that discrepancy over the input. Smooth laws differ at the ends and the
middle."""

# Verdict

NAME_PROBABILITY = 0.9
"""-, probability against its rivals, from which an effect is named by itself. A choice: nine names of ten are
right where it is just met."""
NAME_LEVEL = 6.0
"""standard deviations, below which an effect is not named by them alone. One in a billion: the library is
large and the noise not exactly normal."""
NAME_ALWAYS_LEVEL = 10.0
"""standard deviations, from which an effect can be certain beside something unexplained, and nobody asks how
often noise leaves as much. A choice: far above the six of `NAME_LEVEL`."""
GAP_CLOSURE = 0.9
"""-, share of the gap that a name must close where the gap is clear of noise. A law that is a tenth off, the
largest of `DISCREPANCY_SHARES`, leaves a tenth."""
GAP_CLEAR = 5.0
"""standard deviations of a sum of squares, beyond which a gap is clear of noise. Beyond all chance."""
HARM = 6.0
"""ln predictive density, that a held-out load case may lose to chance. One in four hundred, over eight cases
and several effects."""
HARM_SHARE = 0.02
"""-, share of the total gain that a held-out load case may lose. The shape of an effect's law is not
exact."""
HELD_OUT_LIMIT = 4.0
"""standard deviations, by which the RMS of a load case held out may be above 1. One in thirty thousand, for
each of eight load cases."""
UNLISTED = 0.02
"""-, odds before the records that an effect outside the library is at work. An assumption, stated with the
result."""
RELEVANT = 0.1
"""typical sizes, below which an effect is a trace: seen, but not worth a name. 3.3 standard
deviations of a trace (`TRACE_SD`): one absent effect in a thousand looks so large."""
CONFIDENT = 2.0
"""standard deviations, by which a size must be beyond a limit to count as beyond it. The usual level."""
WRONG_NAME_CHANCE = 0.05
"""-, chance of a wrong name, from which two effects are alike to the records. The usual level."""
DECISIVE_EVIDENCE = 4.6
"""ln evidence, that settles even between effects that are alike. A hundred to one."""
SIZE_APART = 0.1
"""-, of a size, from which a sentence says what it would be in another set. A tenth: a friction is one
number to less."""
RIVAL_LISTED = 0.01
"""-, probability from which a rival is listed. A hundred to one."""
CERTAIN = 6.0
"""log10 odds, beyond which no more is said. What all models share is less sure than a million to one."""
CERTAIN_SHARE = 0.1
"""-, most that may remain unexplained over what an effect explains, in squares, for a name beside something
unexplained. Another effect in its place leaves more than a tenth of it (a bending strut for a
compliant hub leaves two fifths)."""
OWN_CONTRASTS = 0.3
"""-, share of the largest disagreement without an effect, from which a contrast must be explained for a name
beside something unexplained. A choice: what the effect is known by."""
WRONG_NAMES = 0.015
"""-, odds that a name of a set that noise explains is wrong. One of 297 such names of the published benchmark
is (Laplace's rule of succession, 2 in 299); twice that, as the cars of a benchmark are kinder than others."""
RETURNS_FROM = 0.5
"""prior standard deviations from nominal, from which the return of a parameter is worth a line. Room on a
page."""

# Exclusion limits

POWER = 0.84
"""standard deviations above the critical value, at which an effect is found in 80 % of cars. Normal
quantile."""
ONE_SIDED = 1.645
"""standard deviations, one-sided 95 % limit of a size. Normal quantile."""
NOT_SHOWN = 0.9
"""-, standard deviation of a size over that before the records, from which it is not shown by them. A choice:
they take a fifth of the variance away at most."""
SIZE_SEEN = 2.0
"""standard deviations above zero, from which a size that cannot be negative is told from none. Below, a limit
is told: the usual 95 %."""
ALIKE_CORRELATION = 0.8
"""-, |correlation| after re-tuning, from which two effects are listed as alike. A choice: two thirds of the
squares are shared."""
UNSURE_SHARE = 0.005
"""-, share of a change's square below which what re-tuning leaves of it is not believed. Parameters that
follow so far are no longer linear; on a car with one effect 0.001 and 0.02 gave the same verdict and
sizes."""
HIDING_LISTED = 3
"""-, parameters listed that hide an effect. Room on a page."""

# Scan of interfaces

COLUMN_SHARE = 1e-06
"""-, share of a column's square below which re-tuning absorbs it wholly. What is left is rounding of
derivatives."""
PLACE_PROBABILITY = 0.9
"""-, summed probability from which a place is given. As `NAME_PROBABILITY`."""

# Further tests

AMPLITUDE_FACTOR = 1.5
"""-, times the amplitude that was measured, of an advised load case. What rigs and tyres allow."""
TEST_WORTH = 3.0
"""standard deviations, from which a load case is worth running. One in four hundred by chance."""
TESTS_LISTED = 2
"""-, tests that are listed for a pair. Room on a page."""
TESTS_ADVISED = 6
"""-, tests that are listed in all. Room on a page."""
PARAMETERS_LISTED = 8
"""-, parameters that are listed. Room on a page."""
DETECTION_LEVEL = 10.0
"""standard deviations at typical size, up to which parts are advised to be measured. A size then is good to a
tenth."""
PARTS_MOST = 4
"""-, parts to be measured for one effect. More is a tear-down of the axle."""
BENCH_ACCURACY = 0.02
"""-, standard deviation of a measured stiffness or rate. Test benches of bushings and springs."""
BENCH_RADIUS = 0.005
"""-, standard deviation of a measured bar's radius, whose fourth power is its rate. Half a tenth of a
millimetre: a calliper."""
BENCH_POSITION = 0.1
"""mm, standard deviation of a point. Coordinate measuring machine with the parts' own seats."""
BENCH_ANGLE = 0.02
"""deg, standard deviation of an angle. Alignment bench."""
