/* Marches an axle along a load case: predictor, Newton with a kept factorization, step bisection.
   The same algorithm as newton.py and march.py, statement by statement but for the elimination, which is LAPACK's
   there. `residual`, `jacobian`, `outputs`, `state_update` are generated. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef long long integer;
int residual(const double **, double **, integer *, double *, int);
int jacobian(const double **, double **, integer *, double *, int);
int outputs(const double **, double **, integer *, double *, int);
int state_update(const double **, double **, integer *, double *, int);


#define PIVOT_THRESHOLD 0.1     /* least diagonal over the largest number of its column that stays the pivot */

typedef struct {
    int n, active, nu, nz, ny;          /* unknowns, solved ones, controls, states, outputs */
    const int *row, *col;               /* of the Jacobian's nonzeros */
    int nnz;
    const int *order;                   /* equation and unknown of each pivot; the tail's come last */
    const int *tail_control;            /* control that prescribes each tail unknown */
    const double *scale, *c;
    double tol, refresh;                /* force residual in N; contraction that asks for a new Jacobian */
    int max_iterations, max_halvings;
    double *r, *trial_r, *x_trial, *d, *e, *nz_jac, *lu, *inverse_scale;
    int *pivot, *from, *to, *top;       /* of the factorization */
    int *place;                         /* of the Jacobian's nonzeros in it, -1 for those of the tail */
    int have_lu;
    long long counts[4];                /* residuals, Jacobians, factorizations, Newton steps */
} problem;

static void evaluate(problem *p, const double *x, const double *u, const double *z, double *r) {
    const double *arg[4] = {x, p->c, u, z};
    double *result[1] = {r};
    residual(arg, result, 0, 0, 0);
    p->counts[0]++;
}

static double norm(const problem *p, const double *r) {
    double worst = 0.0;
    for (int i = 0; i < p->active; i++) {
        double v = fabs(r[i]) * p->inverse_scale[i];
        if (!(v <= worst)) worst = v;
        if (v != v) return INFINITY;
    }
    return worst;
}

/* LU of a (m, m), column by column. Rows are swapped only where the diagonal is small in its column, so that the
   order of elimination keeps the fill small. from, to: by column, rows below the diagonal between which L is not
   zero; top: the first row of U that is not. 0, or 1 where it is singular. */
FOR_THIS_PROCESSOR
static int eliminate(int m, double *a, int *pivot, int *from, int *to, int *top) {
    for (int k = 0; k < m; k++) {
        int best = k, first = k + 1, end = m, larger = 0;
        double *restrict ck = a + m * k, enough = fabs(ck[k]) / PIVOT_THRESHOLD;
        while (end > first && ck[end - 1] == 0.0) end--;
        while (first < end && ck[first] == 0.0) first++;
        for (int i = first; i < end; i++) larger += fabs(ck[i]) > enough;
        if (larger)
            for (int i = first; i < end; i++)
                if (fabs(ck[i]) > fabs(ck[best])) best = i;
        pivot[k] = best;
        if (!(fabs(ck[best]) > 0.0)) return 1;
        if (best != k) {
            for (int j = 0; j < m; j++) {
                double t = a[k + m * j];
                a[k + m * j] = a[best + m * j];
                a[best + m * j] = t;
            }
        }
        double inverse = 1.0 / ck[k];
        for (int i = first; i < end; i++) ck[i] *= inverse;
        for (int j = k + 1; j < m; j++) {
            double *restrict cj = a + m * j, f = cj[k];
            if (f != 0.0)
                for (int i = first; i < end; i++) cj[i] -= f * ck[i];
        }
    }
    for (int k = 0; k < m; k++) {
        const double *ck = a + m * k;
        for (to[k] = m; to[k] > k + 1 && ck[to[k] - 1] == 0.0; to[k]--) {}
        for (from[k] = k + 1; from[k] < to[k] && ck[from[k]] == 0.0; from[k]++) {}
        for (top[k] = 0; top[k] < k && ck[top[k]] == 0.0; top[k]++) {}
    }
    return 0;
}

FOR_THIS_PROCESSOR
static void substitute(int m, const double *restrict a, const int *pivot, const int *from, const int *to,
                       const int *top, double *restrict d) {
    for (int k = 0; k < m; k++) {
        double t = d[pivot[k]];
        d[pivot[k]] = d[k];
        d[k] = t;
    }
    for (int k = 0; k < m; k++) {
        double f = d[k];
        for (int i = from[k]; i < to[k]; i++) d[i] -= a[i + m * k] * f;
    }
    for (int k = m - 1; k >= 0; k--) {
        double f = d[k] /= a[k + m * k];
        for (int i = top[k]; i < k; i++) d[i] -= a[i + m * k] * f;
    }
}

/* Where the nonzeros stand in the order of elimination. */
static void set_places(problem *p) {
    int *at = p->pivot;
    for (int k = 0; k < p->n; k++) at[p->order[k]] = k;
    for (int k = 0; k < p->nnz; k++) {
        int i = at[p->row[k]], j = at[p->col[k]];
        p->place[k] = i < p->active && j < p->active ? i + p->active * j : -1;
    }
    for (int i = 0; i < p->n; i++) p->inverse_scale[i] = 1.0 / p->scale[i];
}

static int factor(problem *p, const double *x, const double *u, const double *z) {
    const double *arg[4] = {x, p->c, u, z};
    double *result[1] = {p->nz_jac};
    int m = p->active;
    double *a = p->lu;
    jacobian(arg, result, 0, 0, 0);
    p->counts[1]++;
    p->counts[2]++;
    memset(a, 0, sizeof(double) * m * m);
    for (int k = 0; k < p->nnz; k++)
        if (p->place[k] >= 0) a[p->place[k]] = p->nz_jac[k] * p->inverse_scale[p->row[k]];
    p->have_lu = !eliminate(m, a, p->pivot, p->from, p->to, p->top);
    return !p->have_lu;
}

static void solve(problem *p, const double *r, double *d) {
    int m = p->active;
    for (int k = 0; k < m; k++) p->e[k] = r[p->order[k]] * p->inverse_scale[p->order[k]];
    substitute(m, p->lu, p->pivot, p->from, p->to, p->top, p->e);
    for (int k = 0; k < m; k++) d[p->order[k]] = p->e[k];
}

/* Whether a fresh Newton step neither moves the axle nor improves a residual that is small already. */
static int stalled(const problem *p, double now, double next) {
    double largest = 0.0;
    for (int i = 0; i < p->active; i++)
        if (p->scale[i] >= 1.0 && fabs(p->d[i]) > largest) largest = fabs(p->d[i]);
    return next > 0.5 * now && now <= STALL_LEVEL && largest <= STALL_STEP;
}

/* 0 = converged; x holds the result, p->r its residual. */
static int newton(problem *p, double *x, const double *u, const double *z) {
    int n = p->n, m = p->active, fresh = 0, halvings;
    double now, next, damp, best;
    evaluate(p, x, u, z, p->r);
    now = best = norm(p, p->r);
    for (int iterations = 0; iterations < p->max_iterations; iterations++) {
        if (now <= p->tol) return 0;
        if (!isfinite(now) || now > 1e6 * best + 1e9) break;
        if (!p->have_lu) {
            if (factor(p, x, u, z)) break;
            fresh = 1;
        }
        solve(p, p->r, p->d);
        p->counts[3]++;
        for (halvings = 0, damp = 1.0;; halvings++, damp *= 0.5) {
            memcpy(p->x_trial, x, sizeof(double) * n);
            for (int i = 0; i < m; i++) p->x_trial[i] -= damp * p->d[i];
            evaluate(p, p->x_trial, u, z, p->trial_r);
            next = norm(p, p->trial_r);
            if (next <= 10.0 * now || halvings == 6 || (!fresh && p->have_lu)) break;
        }
        if (fresh && stalled(p, now, next)) return 0;
        if (next > p->refresh * now) {
            p->have_lu = 0;
            if (!fresh && !(next <= 0.5 * now)) continue;   /* a stale factorization misled: try a new one */
        }
        fresh = 0;
        memcpy(x, p->x_trial, sizeof(double) * n);
        memcpy(p->r, p->trial_r, sizeof(double) * n);
        now = next;
        if (now < best) best = now;
    }
    return !(now <= p->tol);
}

/* Lagrange extrapolation of the known points to `at`. */
static void predict(int n, int points, const double *s, const double *xs, double at, double *x) {
    memset(x, 0, sizeof(double) * n);
    for (int i = 0; i < points; i++) {
        double weight = 1.0;
        for (int j = 0; j < points; j++)
            if (j != i) weight *= (at - s[j]) / (s[i] - s[j]);
        for (int k = 0; k < n; k++) x[k] += weight * xs[i * n + k];
    }
}

/* mm; 100 mm per Gibbs unit. */
static double distance(const double *a, const double *b, const double *scale, int coordinates) {
    double far = 0.0;
    for (int i = 0; i < coordinates; i++) {
        double d = fabs(a[i] - b[i]) * scale[i];
        if (d > far) far = d;
    }
    return far;
}

static void with_tail(const problem *p, double *x, const double *u) {
    for (int i = p->active; i < p->n; i++) x[i] = u[p->tail_control[i - p->active]];
}

/* One Newton step from x, Euler's along the tangent from the equilibrium of other controls. */
static void step_from(problem *p, double *x, const double *u, const double *z) {
    evaluate(p, x, u, z, p->r);
    if (!p->have_lu && factor(p, x, u, z)) return;
    solve(p, p->r, p->d);
    p->counts[3]++;
    for (int i = 0; i < p->active; i++) x[i] -= p->d[i];
}

/* Whether the way back from x ends where the step began: it does not from beyond a fold. */
static int returns(problem *p, const double *x, double far, const double *last, const double *u,
                   const double *z, double *back, int coordinates) {
    int bad;
    memcpy(back, x, sizeof(double) * p->n);
    with_tail(p, back, u);
    bad = newton(p, back, u, z);
    return !bad && distance(back, last, p->scale, coordinates) <= RETURN * far;
}

/* Whether a motion under friction reverses inside a step from `last` to x. previous: the equilibrium before
   `last`, or NULL; ratio: this step's length over that one's. */
static int slips_back(problem *p, int slips, const int *slip, const double *x, const double *guessed,
                      const double *last, const double *previous, double ratio, const double *u_from,
                      const double *u, const double *z, double *on, double *following) {
    int doubtful = 0;
    for (int j = 0; j < slips; j++) {
        int i = slip[j];
        double slid = x[i] - last[i], before = previous ? (last[i] - previous[i]) * ratio : 0.0;
        if (fabs(slid) <= SLIP) continue;
        if (slid * before < 0.0) return 1;
        if (fabs(slid) < 0.5 * fabs(before) || fabs(x[i] - guessed[i]) > SLIP) doubtful = 1;
    }
    if (!doubtful) return 0;
    for (int i = 0; i < p->nu; i++) on[i] = u[i] + ONWARD * (u[i] - u_from[i]);
    memcpy(following, x, sizeof(double) * p->n);
    with_tail(p, following, on);
    p->have_lu = 0;
    step_from(p, following, on, z);
    for (int j = 0; j < slips; j++) {
        int i = slip[j];
        double slid = x[i] - last[i], ahead = (following[i] - x[i]) / ONWARD;
        if (fabs(slid) > SLIP && slid * ahead < 0.0 && fabs(ahead) > SLIP) return 1;
    }
    return 0;
}

/* Returns 0, or 1 + index of the step that failed. coordinates: unknowns, the first, that are displacements and
   turns. history: `known` points, newest last; with `guess` its
   only point is no equilibrium. end: the last equilibrium's s, u, z and x, and how far off a solution was.
   between: with friction, `passed` rows of step, share, u, x, z of every equilibrium, at most `capacity`. */
int march(int n, int active, int nu, int nz, int ny, int nnz, const int *row, const int *col,
          const int *order, const int *tail_control, const double *scale, const double *c, double tol, double refresh,
          int max_iterations, int max_halvings, int guess, int coordinates, int slips, const int *slip,
          int known, const double *s_known, const double *x_known, const double *u_start, const double *z_start,
          int steps, const double *s, const double *u, double *x_out, double *z_out, double *y_out, double *end,
          long long *counts,
          int capacity, double *between, int *passed) {
    problem p = {n, active, nu, nz, ny, row, col, nnz, order, tail_control, scale, c, tol, refresh,
                 max_iterations, max_halvings};
    double hs[HISTORY + 1], *memory, *hx, *x, *z, *u_now, *u_next, *guessed, *back, *u_on, snap = 0.0, wish = 1.0;
    int points = known < HISTORY ? known : HISTORY, failed = 0;
    double finest = ldexp(1.0, -max_halvings) * (1.0 + 1e-9);
    size_t doubles = 6 * n + nnz + (size_t)n * n + (HISTORY + 1) * n + 3 * n + (nz + 1) + 3 * nu;
    memory = malloc(sizeof(double) * doubles);
    p.pivot = malloc(sizeof(int) * (4 * (size_t)n + nnz));
    if (!memory || !p.pivot) { free(memory); free(p.pivot); return -1; }
    p.from = p.pivot + n;
    p.to = p.from + n;
    p.top = p.to + n;
    p.place = p.top + n;
    double *m = memory;
    p.r = m; m += n;
    p.trial_r = m; m += n;
    p.x_trial = m; m += n;
    p.d = m; m += n;
    p.e = m; m += n;
    p.inverse_scale = m; m += n;
    p.nz_jac = m; m += nnz;
    p.lu = m; m += (size_t)n * n;
    hx = m; m += (HISTORY + 1) * n;
    x = m; m += n;
    z = m; m += nz + 1;
    u_now = m; m += nu;
    u_next = m; m += nu;
    guessed = m; m += n;
    back = m; m += n;
    u_on = m;
    set_places(&p);
    for (int i = 0; i < points; i++) {
        hs[i] = s_known[known - points + i];
        memcpy(hx + i * n, x_known + (size_t)(known - points + i) * n, sizeof(double) * n);
    }
    memcpy(u_now, u_start, sizeof(double) * nu);
    memcpy(z, z_start, sizeof(double) * nz);
    for (int step = 0; step < steps && !failed; step++) {
        const double *target = u + (size_t)step * nu;
        double s_from = hs[points - 1], done = 0.0;
        while (done < 1.0) {
            double part = wish < 1.0 - done ? wish : 1.0 - done;
            double to = done + part >= 1.0 - 1e-12 ? 1.0 : done + part, at = s_from + to * (s[step] - s_from);
            int smooth = 1;
            for (int i = 0; i < nu; i++)
                u_next[i] = to == 1.0 ? target[i] : u_now[i] + (to - done) / (1.0 - done) * (target[i] - u_now[i]);
            const double *last = hx + (points - 1) * n;
            if (points > 1 || guess) {
                predict(n, points, hs, hx, at, x);
                with_tail(&p, x, u_next);
            } else {
                memcpy(x, last, sizeof(double) * n);
                with_tail(&p, x, u_next);
                step_from(&p, x, u_next, z);
            }
            memcpy(guessed, x, sizeof(double) * n);
            int bad = newton(&p, x, u_next, z);
            snap = 0.0;
            if (bad) {      /* the predictor may be at fault: start from the last equilibrium */
                memcpy(x, last, sizeof(double) * n);
                with_tail(&p, x, u_next);
                p.have_lu = 0;
                bad = newton(&p, x, u_next, z);
            }
            if (!bad && !guess) {
                double gap = distance(x, guessed, scale, coordinates), moved = distance(x, last, scale, coordinates);
                int near = gap <= NEGLIGIBLE_DISTANCE;
                if (!near) {
                    double stride = distance(guessed, last, scale, coordinates), longest = INFINITY;
                    if (points > 1)
                        longest = GROWTH * distance(last, last - n, scale, coordinates) * fabs(at - hs[points - 1]) /
                                  fabs(hs[points - 1] - hs[points - 2]);
                    smooth = gap <= SMOOTH * stride;
                    near = gap <= PREDICTION_SHARE * stride && moved <= longest;
                }
                if (!near && !(gap <= CORNER_DISTANCE && returns(&p, x, moved > gap ? moved : gap, last, u_now, z, back, coordinates))) {
                    snap = gap;
                    bad = 1;
                }
            }
            if (!bad && slips && part > finest) {
                const double *previous = points > 1 ? last - n : NULL;
                double ratio = points > 1 ? (at - hs[points - 1]) / (hs[points - 1] - hs[points - 2]) : 0.0;
                bad = slips_back(&p, slips, slip, x, guessed, last, previous, ratio, u_now, u_next, z, u_on, back);
            }
            if (bad) {
                p.have_lu = 0;
                if (part <= finest) { failed = step + 1; break; }
                wish = 0.5 * part;
                continue;
            }
            if (nz) {
                if (*passed < capacity) {
                    double *row = between + (size_t)*passed * (2 + nu + n + nz);
                    row[0] = step;
                    row[1] = to;
                    memcpy(row + 2, u_next, sizeof(double) * nu);
                    memcpy(row + 2 + nu, x, sizeof(double) * n);
                    memcpy(row + 2 + nu + n, z, sizeof(double) * nz);
                }
                ++*passed;
                const double *arg[4] = {x, c, u_next, z};
                double *result[1] = {z_out + (size_t)step * nz};
                state_update(arg, result, 0, 0, 0);
                memcpy(z, z_out + (size_t)step * nz, sizeof(double) * nz);
            }
            if (points == HISTORY) {
                memmove(hs, hs + 1, sizeof(double) * (HISTORY - 1));
                memmove(hx, hx + n, sizeof(double) * (HISTORY - 1) * n);
                points--;
            }
            hs[points] = at;
            memcpy(hx + points * n, x, sizeof(double) * n);
            points++;
            memcpy(u_now, u_next, sizeof(double) * nu);
            done = to;
            if (smooth && wish < 1.0) wish = 2.0 * wish < 1.0 ? 2.0 * wish : 1.0;
        }
        if (!failed) {
            memcpy(x_out + (size_t)step * n, x, sizeof(double) * n);
            const double *arg[4] = {x, c, u_next, z};
            double *result[1] = {y_out + (size_t)step * ny};
            outputs(arg, result, 0, 0, 0);
        }
    }
    end[0] = hs[points - 1];
    end[1] = snap;
    memcpy(end + 2, u_now, sizeof(double) * nu);
    memcpy(end + 2 + nu, z, sizeof(double) * nz);
    memcpy(end + 2 + nu + nz, hx + (points - 1) * n, sizeof(double) * n);
    memcpy(counts, p.counts, sizeof(p.counts));
    free(memory);
    free(p.pivot);
    return failed;
}
