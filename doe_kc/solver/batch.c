/* Marches several designs, or one along several load cases, one in each lane of the vector registers: the algorithm
   of driver.c. Every lane has its own steps, Newton iterations and factorization; what all wait for is computed at once.
   No number of one lane depends on its neighbours. `residual`, `jacobian`, `outputs`, `state_update` are generated
   for lanes, `constants` for one design. */
#include <stdlib.h>
#include <string.h>

typedef long long integer;
int residual(const lane **, lane **, integer *, lane *, int);
int jacobian(const lane **, lane **, integer *, lane *, int);
int outputs(const lane **, lane **, integer *, lane *, int);
int state_update(const lane **, lane **, integer *, lane *, int);
int constants(const double **, double **, integer *, double *, int);

#define DULL 0.5                /* contraction above which a factorization is renewed at once, ... */
#define SLOW 2                  /* as after more than so many slow ones of an equilibrium; ... */
#define TOGETHER 2              /* else at the next multiple of so many steps, together with that of other lanes */
#define LARGEST_FACTOR 1e8      /* of the elimination, whose order is the same for all designs */

/* What a lane waits for: parts of one round, in the order in which they are done; UPDATE before a round. */
enum { ACCEPT = 1, FACTOR = 2, SOLVE = 4, TRY = 8, EVALUATE = 16, UPDATE = 32, MEET = 64, PARTS = 5 };

/* Sizes and settings as in driver.c, and the pattern of L, U in the order of elimination. */
typedef struct {
    int n, active, nu, nz, ny, nc, nnz;
    const int *tail_control;
    const double *scale;
    double tol, refresh;
    int max_iterations, max_halvings, guess, coordinates, slips;
    const int *slip;
    const int *row_of, *column_of;          /* (active) equation and unknown of each pivot */
    const int *l_start, *l_row;             /* by pivot: rows below it */
    const int *u_start, *u_column;          /* by pivot: columns right of it */
    const int *place;                       /* (nnz) of the Jacobian's numbers among those of L, U, D; below 0: none */
    const int *target;                      /* of every product of the elimination, in its order */
    const int *nonzero_row;                 /* (nnz) */
    int columns;
    const int *column;                      /* of the outputs that are asked for */
    int meet;                               /* whether a stale factorization waits for those of other lanes */
    int capacity;                           /* equilibria a lane that `between` has room for */
} problem;

/* One design on its way. Pointers to rows of numbers of its own. */
typedef struct {
    int own;                                /* which of the batch it is */
    int at, newton_at;                      /* where `go_on` and `newton` resume */
    int steps, step, points, have_lu, stale, singular, failed, smooth;
    int iterations, slow, fresh, halvings, accepted, work, bad;
    double now, best, damp, done, to, here, part, wish, gap, s_from, far;
    double hs[HISTORY + 1];
    double *hx, *x, *guessed, *back, *u_now, *u_next, *u_on;
    const lane *solved;                     /* where Newton's method left its result */
    const double *s, *u;
    double *x_out, *z_out, *between;
    int passed;                             /* equilibria, those inside steps included */
    long long counts[4];                    /* residuals, Jacobians, factorizations, Newton steps */
} design;

typedef struct {
    const problem *p;
    const lane *c;
    lane *x, *x_trial, *r, *trial_r, *d, *y, *nonzeros, *factors, *fresh_factors, *u, *z, *z_next, *out, *inverse_scale;
    lane damp, level;
    int want[LANES];
    design lanes[LANES];
    long long *counts;                      /* calls of residual, jacobian, solve, outputs */
} block;

/* All designs of a call, see `march_batch`; those from `next` to `end` wait for a lane. */
typedef struct {
    int next, end, steps, known;
    const int *steps_of;
    const double *c, *s_known, *x_known, *u_start, *s, *u;
    double *z_end, *x_out, *y_out, *z_out, *between;
    double *z_rows;                         /* (LANES, steps, nz) in place of z_out */
    int *failed, *passed, *done;            /* done: steps of each, where its outputs are written at the end */
    long long *own_counts;
} batch;

static void put(lane *to, int l, const double *from, int count) {
    double *column = (double *)to + l;
    for (int i = 0; i < count; i++) column[(size_t)i * LANES] = from[i];
}

static void get(double *to, const lane *from, int l, int count) {
    const double *column = (const double *)from + l;
    for (int i = 0; i < count; i++) to[i] = column[(size_t)i * LANES];
}

/* LU of the Jacobians at x in the given order; `singular` where a lane's cannot be eliminated so. */
static void factor(block *b, lane_mask wanted) {
    const problem *p = b->p;
    const lane *arg[4] = {b->x, b->c, b->u, b->z};
    lane *result[1] = {b->nonzeros}, largest = lane_of(0.0);
    int m = p->active, lower = p->l_start[m], upper = lower + p->u_start[m], all = upper + m;
    lane *f = b->fresh_factors;
    const int *target = p->target;
    jacobian(arg, result, 0, 0, 0);
    b->counts[1]++;
    memset(f, 0, sizeof(lane) * all);
    for (int k = 0; k < p->nnz; k++)
        if (p->place[k] >= 0) f[p->place[k]] = b->nonzeros[k] * b->inverse_scale[p->nonzero_row[k]];
    for (int k = 0; k < m; k++) {
        lane inverse = 1.0 / f[upper + k];
        const lane *row = f + lower + p->u_start[k];
        int count = p->u_start[k + 1] - p->u_start[k];
        f[upper + k] = inverse;
        for (int i = p->l_start[k]; i < p->l_start[k + 1]; i++) {
            lane v = f[i] *= inverse;
            largest = lane_fmax(lane_fabs(v), largest);
            for (int j = 0; j < count; j++) f[target[j]] -= v * row[j];
            target += count;
        }
        largest = lane_select(inverse == inverse, largest, lane_of(INFINITY));
    }
    for (int k = 0; k < all; k++) b->factors[k] = lane_select(wanted, f[k], b->factors[k]);
    for (int l = 0; l < LANES; l++)
        if (wanted[l]) b->lanes[l].singular = !(largest[l] <= LARGEST_FACTOR);
}

static void solve(block *b, lane_mask wanted) {
    const problem *p = b->p;
    int m = p->active, lower = p->l_start[m], upper = lower + p->u_start[m];
    const lane *f = b->factors;
    lane *y = b->y;
    for (int k = 0; k < m; k++) y[k] = b->r[p->row_of[k]] * b->inverse_scale[p->row_of[k]];
    for (int k = 0; k < m; k++) {
        lane v = y[k];
        for (int i = p->l_start[k]; i < p->l_start[k + 1]; i++) y[p->l_row[i]] -= f[i] * v;
    }
    for (int k = m - 1; k >= 0; k--) {
        lane sum = y[k], other = lane_of(0.0);     /* two sums: each waits for its last product */
        int j = p->u_start[k], end = p->u_start[k + 1];
        for (; j + 1 < end; j += 2) {
            sum -= f[lower + j] * y[p->u_column[j]];
            other -= f[lower + j + 1] * y[p->u_column[j + 1]];
        }
        if (j < end) sum -= f[lower + j] * y[p->u_column[j]];
        sum += other;
        y[k] = sum * f[upper + k];
    }
    for (int k = 0; k < m; k++) {
        lane *d = b->d + p->column_of[k];
        *d = lane_select(wanted, y[k], *d);
    }
    b->counts[2]++;
}

static void evaluate(block *b) {
    const lane *arg[4] = {b->x_trial, b->c, b->u, b->z};
    lane *result[1] = {b->trial_r}, worst = lane_of(0.0);
    lane_mask unknown = worst != worst;
    residual(arg, result, 0, 0, 0);
    b->counts[0]++;
    for (int i = 0; i < b->p->active; i++) {
        lane v = lane_fabs(b->trial_r[i]) * b->inverse_scale[i];
        unknown |= v != v;
        worst = lane_fmax(v, worst);
    }
    b->level = lane_select(unknown, lane_of(INFINITY), worst);
}

static void update(block *b, lane_mask wanted) {
    const lane *arg[4] = {b->x_trial, b->c, b->u, b->z};
    lane *result[1] = {b->z_next};
    state_update(arg, result, 0, 0, 0);
    for (int i = 0; i < b->p->nz; i++) b->z[i] = lane_select(wanted, b->z_next[i], b->z[i]);
}

static int stalled(const block *b, const design *t, int l, double next) {
    double largest = 0.0;
    if (!(next > 0.5 * t->now && t->now <= STALL_LEVEL)) return 0;
    for (int i = 0; i < b->p->active; i++)
        if (b->p->scale[i] >= 1.0 && fabs(b->d[i][l]) > largest) largest = fabs(b->d[i][l]);
    return largest <= STALL_STEP;
}

/* The function returns what it waits for and goes on here when it is called again. */
#define AWAIT(place, what) do { place = __LINE__; return what; case __LINE__:; } while (0)

/* Newton's method from x_trial; 0 when it has ended, its result at `solved`. */
static int newton(block *b, design *t, int l) {
    const problem *p = b->p;
    double next;
    switch (t->newton_at) {
    case 0:
        t->fresh = t->slow = 0;
        t->accepted = ACCEPT;
        AWAIT(t->newton_at, EVALUATE);
        t->now = t->best = b->level[l];
        for (t->iterations = 0; t->iterations < p->max_iterations; t->iterations++) {
            if (t->now <= p->tol || !isfinite(t->now) || t->now > 1e6 * t->best + 1e9) break;
            t->work = t->accepted | SOLVE | TRY | EVALUATE;
            if (!t->have_lu) {
                t->work |= FACTOR;
                t->fresh = t->have_lu = 1;
            }
            for (t->halvings = 0, b->damp[l] = 1.0;; t->halvings++, b->damp[l] *= 0.5) {
                AWAIT(t->newton_at, t->work);
                next = b->level[l];
                if (next <= 10.0 * t->now || t->halvings == 6 || !t->fresh || t->singular) break;
                t->work = TRY | EVALUATE;
            }
            if (t->singular) {
                t->have_lu = 0;
                t->bad = 1;
                return 0;
            }
            if (t->fresh && stalled(b, t, l, next)) {
                t->solved = b->x;
                t->bad = 0;
                return 0;
            }
            t->accepted = ACCEPT;
            if (next > p->refresh * t->now) {
                if (p->meet && next <= DULL * t->now && t->slow++ < SLOW) t->stale = 1;
                else t->have_lu = 0;
                if (!t->fresh && !(next <= 0.5 * t->now)) {
                    t->accepted = 0;
                    continue;
                }
            }
            t->fresh = 0;
            t->now = next;
            if (next < t->best) t->best = next;
        }
    }
    t->solved = b->x_trial;
    t->bad = !(t->now <= p->tol);
    return 0;
}

/* Lagrange extrapolation of the known points to `here`. */
static void predict(const design *t, int n) {
    memset(t->x, 0, sizeof(double) * n);
    for (int i = 0; i < t->points; i++) {
        double weight = 1.0;
        const double *from = t->hx + (size_t)i * n;
        for (int j = 0; j < t->points; j++)
            if (j != i) weight *= (t->here - t->hs[j]) / (t->hs[i] - t->hs[j]);
        for (int k = 0; k < n; k++) t->x[k] += weight * from[k];
    }
}

static double distance(const problem *p, const double *a, const double *b) {
    double far = 0.0;
    for (int i = 0; i < p->coordinates; i++) {
        double d = fabs(a[i] - b[i]) * p->scale[i];
        if (d > far) far = d;
    }
    return far;
}

/* A state, with what the controls prescribe of it, to be tried under these controls. */
static void offer(block *b, int l, double *x, const double *u) {
    const problem *p = b->p;
    for (int i = p->active; i < p->n; i++) x[i] = u[p->tail_control[i - p->active]];
    put(b->x_trial, l, x, p->n);
    put(b->u, l, u, p->nu);
}

/* Whether a motion under friction reverses: 1 yes, 0 no, -1 the tangent at the end of the step has to tell. */
static int reverses(const problem *p, const design *t, const double *last) {
    int doubtful = 0;
    double ratio = t->points > 1 ? (t->here - t->hs[t->points - 1]) / (t->hs[t->points - 1] - t->hs[t->points - 2]) : 0.0;
    for (int j = 0; j < p->slips; j++) {
        int i = p->slip[j];
        double slid = t->x[i] - last[i], before = t->points > 1 ? (last[i] - last[i - p->n]) * ratio : 0.0;
        if (fabs(slid) <= SLIP) continue;
        if (slid * before < 0.0) return 1;
        if (fabs(slid) < 0.5 * fabs(before) || fabs(t->x[i] - t->guessed[i]) > SLIP) doubtful = 1;
    }
    return -doubtful;
}

/* The same by the tangent, which leads to `back`. */
static int reverses_ahead(const problem *p, const design *t, const double *last) {
    for (int j = 0; j < p->slips; j++) {
        int i = p->slip[j];
        double slid = t->x[i] - last[i], ahead = (t->back[i] - t->x[i]) / ONWARD;
        if (fabs(slid) > SLIP && slid * ahead < 0.0 && fabs(ahead) > SLIP) return 1;
    }
    return 0;
}

static void accept_point(const problem *p, design *t) {
    size_t row = sizeof(double) * p->n;
    if (t->points == HISTORY) {
        memmove(t->hs, t->hs + 1, sizeof(double) * (HISTORY - 1));
        memmove(t->hx, t->hx + p->n, row * (HISTORY - 1));
        t->points--;
    }
    t->hs[t->points] = t->here;
    memcpy(t->hx + (size_t)t->points * p->n, t->x, row);
    t->points++;
    memcpy(t->u_now, t->u_next, sizeof(double) * p->nu);
    t->done = t->to;
    if (t->smooth && t->wish < 1.0) t->wish = 2.0 * t->wish < 1.0 ? 2.0 * t->wish : 1.0;
}

/* The equilibrium that was found, with the friction states before it: step, share of it, u, x, z. */
static void keep(const block *b, design *t, int l) {
    const problem *p = b->p;
    if (t->passed < p->capacity) {
        double *row = t->between + (size_t)t->passed * (2 + p->nu + p->n + p->nz);
        row[0] = t->step;
        row[1] = t->to;
        memcpy(row + 2, t->u_next, sizeof(double) * p->nu);
        memcpy(row + 2 + p->nu, t->x, sizeof(double) * p->n);
        get(row + 2 + p->nu + p->n, b->z, l, p->nz);
    }
    t->passed++;
}

static void begin_part(const problem *p, design *t) {
    const double *target = t->u + (size_t)t->step * p->nu;
    t->part = t->wish < 1.0 - t->done ? t->wish : 1.0 - t->done;
    t->to = t->done + t->part >= 1.0 - 1e-12 ? 1.0 : t->done + t->part;
    t->here = t->s_from + t->to * (t->s[t->step] - t->s_from);
    t->smooth = 1;
    for (int i = 0; i < p->nu; i++)
        t->u_next[i] = t->to == 1.0 ? target[i]
                                    : t->u_now[i] + (t->to - t->done) / (1.0 - t->done) * (target[i] - t->u_now[i]);
}

/* Whether x continues the path; -1 when the way back has to tell. */
static int continues(const problem *p, design *t, const double *last) {
    double gap, moved, stride, longest = INFINITY;
    int newest = t->points - 1;
    if (p->guess) return 1;
    gap = distance(p, t->x, t->guessed);
    if (gap <= NEGLIGIBLE_DISTANCE) return 1;
    moved = distance(p, t->x, last);
    stride = distance(p, t->guessed, last);
    if (newest > 0)
        longest = GROWTH * distance(p, last, last - p->n) * fabs(t->here - t->hs[newest]) /
                  fabs(t->hs[newest] - t->hs[newest - 1]);
    t->smooth = gap <= SMOOTH * stride;
    if (gap <= PREDICTION_SHARE * stride && moved <= longest) return 1;
    t->far = moved > gap ? moved : gap;
    return gap <= CORNER_DISTANCE ? -1 : 0;
}

#define RUN_NEWTON \
    do { \
        t->newton_at = 0; \
        t->at = __LINE__; \
        case __LINE__: \
            if ((want = newton(b, t, l))) return want; \
    } while (0)

#define LAST (t->hx + (size_t)(t->points - 1) * p->n)

/* The march of one design; 0 when it has ended. `failed`: 1 + index of the step that failed, or 0. */
static int go_on(block *b, design *t, int l) {
    const problem *p = b->p;
    size_t row = sizeof(double) * p->n;
    double finest = ldexp(1.0, -p->max_halvings) * (1.0 + 1e-9);
    int want;
    switch (t->at) {
    case 0:
        for (t->step = 0; t->step < t->steps; t->step++) {
            if (p->meet && t->step && t->step % TOGETHER == 0) {
                AWAIT(t->at, MEET);
                if (t->stale) t->have_lu = t->stale = 0;
            }
            t->s_from = t->hs[t->points - 1];
            t->done = 0.0;
            while (t->done < 1.0) {
                begin_part(p, t);
                if (t->points > 1 || p->guess) {
                    predict(t, p->n);
                    offer(b, l, t->x, t->u_next);
                } else {
                    memcpy(t->x, LAST, row);
                    offer(b, l, t->x, t->u_next);
                    AWAIT(t->at, EVALUATE);
                    t->work = ACCEPT | SOLVE | TRY | (t->have_lu ? 0 : FACTOR);
                    t->have_lu = 1;
                    b->damp[l] = 1.0;
                    AWAIT(t->at, t->work);
                    if (t->singular) goto failure;
                    get(t->x, b->x_trial, l, p->n);
                }
                memcpy(t->guessed, t->x, row);
                RUN_NEWTON;
                if (t->bad) {   /* the predictor may be at fault: start from the last equilibrium */
                    memcpy(t->x, LAST, row);
                    offer(b, l, t->x, t->u_next);
                    t->have_lu = 0;
                    RUN_NEWTON;
                }
                if (!t->bad) {
                    get(t->x, t->solved, l, p->n);
                    t->bad = continues(p, t, LAST) - 1;
                    if (t->bad < -1) {
                        memcpy(t->back, t->x, row);
                        offer(b, l, t->back, t->u_now);
                        RUN_NEWTON;
                        if (!t->bad) get(t->back, t->solved, l, p->n);
                        t->bad = t->bad || distance(p, t->back, LAST) > RETURN * t->far;
                    }
                }
                if (!t->bad && p->slips && t->part > finest) {
                    t->bad = reverses(p, t, LAST);
                    if (t->bad < 0) {
                        for (int i = 0; i < p->nu; i++) t->u_on[i] = t->u_next[i] + ONWARD * (t->u_next[i] - t->u_now[i]);
                        memcpy(t->back, t->x, row);
                        offer(b, l, t->back, t->u_on);
                        AWAIT(t->at, EVALUATE);
                        t->have_lu = 1;
                        b->damp[l] = 1.0;
                        AWAIT(t->at, ACCEPT | FACTOR | SOLVE | TRY);
                        if (t->singular) goto failure;
                        get(t->back, b->x_trial, l, p->n);
                        t->bad = reverses_ahead(p, t, LAST);
                    }
                }
                if (t->bad) {
                    t->have_lu = 0;
                    if (t->part <= finest) goto failure;
                    t->wish = 0.5 * t->part;
                    continue;
                }
                if (p->nz) {
                    keep(b, t, l);
                    offer(b, l, t->x, t->u_next);
                    AWAIT(t->at, UPDATE);
                    get(t->z_out + (size_t)t->step * p->nz, b->z, l, p->nz);
                }
                accept_point(p, t);
            }
            memcpy(t->x_out + (size_t)t->step * p->n, t->x, row);
        }
        t->failed = 0;
        return 0;
    }
failure:
    t->failed = t->step + 1;
    return 0;
}

/* What one lane does, as driver.c counts it. */
static void count(long long *counts, int want) {
    counts[0] += (want & EVALUATE) != 0;
    counts[1] += (want & FACTOR) != 0;
    counts[2] += (want & FACTOR) != 0;
    counts[3] += (want & SOLVE) != 0;
}

/* Lane `l` on the numbers of design i: those that it marches from, and where those that it passes go. */
static void seat(block *b, const batch *all, int l, int i) {
    const problem *p = b->p;
    design *t = b->lanes + l;
    put((lane *)b->c, l, all->c + (size_t)i * p->nc, p->nc);
    put(b->z, l, all->z_end + (size_t)i * p->nz, p->nz);
    t->s = all->s + (size_t)i * all->steps;
    t->u = all->u + (size_t)i * all->steps * p->nu;
    t->x_out = all->x_out + (size_t)i * all->steps * p->n;
    t->z_out = all->z_out ? all->z_out + (size_t)i * all->steps * p->nz : all->z_rows + (size_t)l * all->steps * p->nz;
    if (all->between) t->between = all->between + (size_t)i * p->capacity * (2 + p->nu + p->n + p->nz);
}

/* Lane `l` takes design i. */
static void begin(block *b, const batch *all, int l, int i) {
    const problem *p = b->p;
    design *t = b->lanes + l;
    const double *s_known = all->s_known + (size_t)i * all->known;
    const double *x_known = all->x_known + (size_t)i * all->known * p->n;
    seat(b, all, l, i);
    t->own = i;
    t->steps = all->failed[i] ? 0 : all->steps_of[i];
    t->step = 0;
    t->points = all->known < HISTORY ? all->known : HISTORY;
    for (int k = 0; k < t->points; k++) t->hs[k] = s_known[all->known - t->points + k];
    memcpy(t->hx, x_known + (size_t)(all->known - t->points) * p->n, sizeof(double) * t->points * p->n);
    memcpy(t->u_now, all->u_start + (size_t)i * p->nu, sizeof(double) * p->nu);
    t->at = t->have_lu = t->stale = t->singular = t->passed = 0;
    memset(t->counts, 0, sizeof(t->counts));
    t->wish = 1.0;
}

/* The design of lane `l` has ended: what is left of it that is not where it goes. */
static void end(const block *b, const batch *all, int l) {
    const design *t = b->lanes + l;
    int i = t->own;
    all->failed[i] = t->failed;
    get(all->z_end + (size_t)i * b->p->nz, b->z, l, b->p->nz);
    if (all->own_counts) memcpy(all->own_counts + 4 * i, t->counts, sizeof(t->counts));
    if (all->passed) all->passed[i] = t->passed;
    all->done[i] = t->step;
}

/* What the lane waits for next, with the next design where its own has ended; 0 when none is left. */
static int advance(block *b, batch *all, int l) {
    design *t = b->lanes + l;
    for (;;) {
        int want = t->steps ? go_on(b, t, l) : 0;
        if (want) return want;
        if (t->steps) end(b, all, l);
        t->steps = 0;
        if (all->next >= all->end) return 0;
        begin(b, all, l, all->next++);
    }
}

static void run(block *b, batch *all) {
    lane_mask of[PARTS];
    for (int l = 0; l < LANES; l++) b->want[l] = advance(b, all, l);
    for (;;) {
        int any = 0, meet = 0, others = 0, waiting = 0, moving = 0, now[LANES];
        for (int l = 0; l < LANES; l++) {
            moving |= b->want[l] == UPDATE;
            of[0][l] = -(integer)(b->want[l] == UPDATE);
        }
        if (moving) {   /* at once: what comes next needs all the others' time again */
            update(b, of[0]);
            for (int l = 0; l < LANES; l++)
                if (b->want[l] == UPDATE) b->want[l] = advance(b, all, l);
        }
        for (int l = 0; l < LANES; l++) {   /* a Jacobian costs four residuals: a few that want one wait for more */
            waiting += (b->want[l] & FACTOR) != 0;
            others += b->want[l] && !(b->want[l] & (FACTOR | MEET));
        }
        for (int l = 0; l < LANES; l++) {
            now[l] = others && waiting < LANES / 2 && b->want[l] & FACTOR ? 0 : b->want[l];
            any |= now[l] & ~MEET, meet |= now[l] & MEET;
        }
        if (!any && !meet) return;
        for (int part = 0; part < PARTS; part++)
            for (int l = 0; l < LANES; l++) of[part][l] = -(integer)(now[l] >> part & 1);
        for (int l = 0; l < LANES; l++) count(b->lanes[l].counts, now[l]);
        if (any & ACCEPT)
            for (int i = 0; i < b->p->n; i++) {
                b->x[i] = lane_select(of[0], b->x_trial[i], b->x[i]);
                b->r[i] = lane_select(of[0], b->trial_r[i], b->r[i]);
            }
        if (any & FACTOR) factor(b, of[1]);
        if (any & SOLVE) solve(b, of[2]);
        if (any & TRY) {
            for (int i = 0; i < b->p->active; i++)
                b->x_trial[i] = lane_select(of[3], b->x[i] - b->damp * b->d[i], b->x_trial[i]);
            for (int i = b->p->active; i < b->p->n; i++) b->x_trial[i] = lane_select(of[3], b->x[i], b->x_trial[i]);
        }
        if (any & EVALUATE) evaluate(b);
        for (int l = 0; l < LANES; l++)
            if (now[l] && (!any || now[l] != MEET)) b->want[l] = advance(b, all, l);
    }
}

static double *numbers(double **memory, size_t count) {
    double *first = *memory;
    *memory += count;
    return first;
}

static lane *lanes_of(lane **memory, size_t count) {
    lane *first = *memory;
    *memory += count;
    return first;
}

static void open_block(block *b, const problem *p, lane *memory, double *own) {
    int all = p->l_start[p->active] + p->u_start[p->active] + p->active;
    b->p = p;
    b->x = lanes_of(&memory, p->n);
    b->x_trial = lanes_of(&memory, p->n);
    b->r = lanes_of(&memory, p->n);
    b->trial_r = lanes_of(&memory, p->n);
    b->d = lanes_of(&memory, p->n);
    b->y = lanes_of(&memory, p->n);
    b->inverse_scale = lanes_of(&memory, p->n);
    b->nonzeros = lanes_of(&memory, p->nnz);
    b->factors = lanes_of(&memory, all);
    b->fresh_factors = lanes_of(&memory, all);
    b->u = lanes_of(&memory, p->nu);
    b->z = lanes_of(&memory, p->nz);
    b->z_next = lanes_of(&memory, p->nz);
    b->out = lanes_of(&memory, p->ny);
    b->c = lanes_of(&memory, p->nc);
    for (int i = 0; i < p->n; i++) b->inverse_scale[i] = lane_of(1.0 / p->scale[i]);
    for (int l = 0; l < LANES; l++) {
        design *t = b->lanes + l;
        t->hx = numbers(&own, (size_t)(HISTORY + 1) * p->n);
        t->x = numbers(&own, p->n);
        t->guessed = numbers(&own, p->n);
        t->back = numbers(&own, p->n);
        t->u_now = numbers(&own, p->nu);
        t->u_next = numbers(&own, p->nu);
        t->u_on = numbers(&own, p->nu);
    }
}

/* y of every step that all lanes have passed or that some have: the others' numbers are never read. first: design of
   the first lane. */
static void write_outputs(block *b, const batch *all, int first) {
    const problem *p = b->p;
    const lane *arg[4] = {b->x_trial, b->c, b->u, b->z};
    lane *result[1] = {b->out};
    for (int step = 0; step < all->steps; step++) {
        int any = 0;
        for (int l = 0; l < LANES; l++) {
            const design *t = b->lanes + l;
            if (step >= t->step) continue;
            any = 1;
            put(b->x_trial, l, t->x_out + (size_t)step * p->n, p->n);
            put(b->u, l, t->u + (size_t)step * p->nu, p->nu);
            put(b->z, l, t->z_out + (size_t)step * p->nz, p->nz);
        }
        if (!any) return;
        outputs(arg, result, 0, 0, 0);
        b->counts[3]++;
        for (int l = 0; l < LANES; l++) {
            if (step >= b->lanes[l].step) continue;
            double *row = all->y_out + ((size_t)(first + l) * all->steps + step) * p->columns;
            for (int i = 0; i < p->columns; i++) row[i] = b->out[p->column[i]][l];
        }
    }
}

/* Lanes on designs first, first + 1, ...; a lane without a design of its own idles on the numbers of the first. */
static void begin_lanes(block *b, const batch *all, int first, int designs) {
    for (int l = 0; l < LANES; l++) {
        begin(b, all, l, first + l < designs ? first + l : first);
        if (first + l >= designs) b->lanes[l].steps = 0;
    }
}

/* Designs of c (designs, nc) from their known points s_known (designs, known), x_known (designs, known, n) over s
   (designs, steps) under u (designs, steps, nu), those alone for which failed[design] is 0, each over its own number
   of steps, steps_of (designs). x, y: (designs, steps, .) of the steps passed; z_end: (designs, nz), in: before the
   march, out: after it. failed: 1 + index of the step that has no equilibrium in this way, or 0. counts: (4) calls of
   residual, jacobian, solve and outputs, each for all lanes.
   Where they are not NULL: z_out (designs, steps, nz); own_counts (designs, 4), see `design`; between, with friction,
   `passed` (designs) rows of step, share, u, x, z of every equilibrium, at most `capacity` a design.
   Returns 0, or -1 without memory. */
int march_batch(int n, int active, int nu, int nz, int ny, int nc, int nnz, const int *tail_control, const double *scale,
                double tol, double refresh, int max_iterations, int max_halvings, int guess, int coordinates, int slips,
                const int *slip,
                const int *row_of, const int *column_of, const int *l_start, const int *l_row, const int *u_start,
                const int *u_column, const int *place, const int *target, const int *nonzero_row,
                int columns, const int *column, int designs, const double *c, int known, const double *s_known,
                const double *x_known, const double *u_start_point, double *z_end, int steps, const int *steps_of,
                const double *s, const double *u, double *x_out, double *y_out, int *failed, long long *counts,
                double *z_out, long long *own_counts, int capacity, double *between, int *passed) {
    problem p = {n, active, nu, nz, ny, nc, nnz, tail_control, scale, tol, refresh, max_iterations, max_halvings,
                 guess, coordinates, slips, slip, row_of, column_of, l_start, l_row, u_start, u_column, place, target,
                 nonzero_row, columns, column, !z_out, between ? capacity : 0};
    block b;
    size_t filled = (size_t)l_start[active] + u_start[active] + active;
    size_t vectors = 7 * (size_t)n + nnz + 2 * filled + nu + 2 * (size_t)nz + ny + nc;
    size_t own = ((HISTORY + 4) * (size_t)n + 3 * (size_t)nu) * LANES, path = (size_t)steps * nz;
    lane *memory = aligned_alloc(sizeof(lane), sizeof(lane) * vectors);
    double *rows = malloc(sizeof(double) * (own + (z_out ? 0 : LANES * path) + 1));
    int *done = calloc(designs + 1, sizeof(int)), together = z_out ? designs : LANES;
    batch all = {0, 0, steps, known, steps_of, c, s_known, x_known, u_start_point, s, u, z_end, x_out, y_out, z_out,
                 between, rows + own, failed, passed, done, own_counts};
    if (!memory || !rows || !done) { free(memory); free(rows); free(done); return -1; }
    memset(memory, 0, sizeof(lane) * vectors);
    memset(&b, 0, sizeof(b));
    open_block(&b, &p, memory, rows);
    b.counts = counts;
    /* Load cases of one axle, of different lengths: a lane takes the next one as soon as it is free. Designs of one
       length have their steps in common, which they keep when they begin together. */
    for (int first = 0; first < designs; first += together) {
        all.next = first + LANES;
        all.end = first + together < designs ? first + together : designs;
        begin_lanes(&b, &all, first, designs);
        run(&b, &all);
        for (int i = first; i < all.end; i += LANES) {
            for (int l = 0; l < LANES; l++) {
                seat(&b, &all, l, i + l < designs ? i + l : i);
                b.lanes[l].step = i + l < designs ? done[i + l] : 0;
            }
            write_outputs(&b, &all, i);
        }
    }
    free(memory);
    free(rows);
    free(done);
    return 0;
}

#ifndef NO_CONSTANTS
/* c (designs, nc) of the internal parameters p (designs, np). */
void constants_batch(int designs, int np, int nc, const double *p, double *c) {
    for (int i = 0; i < designs; i++) {
        const double *arg[1] = {p + (size_t)i * np};
        double *result[1] = {c + (size_t)i * nc};
        constants(arg, result, 0, 0, 0);
    }
}
#endif
