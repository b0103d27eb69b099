/* Derivatives of consecutive equilibria to parameters, by the implicit function theorem: the same algorithm as
   InterpretedDerivatives of derivatives.py. `derivatives`, which gives all blocks of one point, is generated. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef long long integer;

int derivatives(const double **, double **, integer *, double *, int);
const integer *derivatives_sparsity_out(integer);

#define INLINE static inline __attribute__((always_inline))
#define TILE 32         /* columns that are handled at once, in registers */

enum { R_X, R_C, R_U, Y_X, Y_C, Y_U, R_Z, Y_Z, Z_X, Z_C, Z_U, Z_Z, BLOCKS };

/* A sparse block: numbers column by column as generated code gives them, and their order row by row. */
typedef struct {
    int rows, columns;
    const integer *start, *row;         /* by column */
    int *row_start, *place, *column;    /* by row: which number, in which column */
    double *value;
} block;

typedef struct {
    int columns, stride;                /* of right-hand sides; stride: a multiple of TILE */
    const int *start, *column;          /* dc by row */
    const double *value;
    int directions;
    const double *direction;            /* (directions, columns) */
} right_side;

static int open_block(block *b, int index) {
    const integer *pattern = derivatives_sparsity_out(index);
    b->rows = (int)pattern[0];
    b->columns = (int)pattern[1];
    b->start = pattern + 2;
    b->row = b->start + b->columns + 1;
    int count = (int)b->start[b->columns];
    b->row_start = calloc(b->rows + 2, sizeof(int));
    b->place = malloc(sizeof(int) * (count + 1));
    b->column = malloc(sizeof(int) * (count + 1));
    b->value = malloc(sizeof(double) * (count + 1));
    if (!b->row_start || !b->place || !b->column || !b->value) return 1;
    for (int k = 0; k < count; k++) b->row_start[b->row[k] + 2]++;
    for (int i = 0; i < b->rows; i++) b->row_start[i + 2] += b->row_start[i + 1];
    for (int j = 0; j < b->columns; j++)
        for (integer k = b->start[j]; k < b->start[j + 1]; k++) {
            int at = b->row_start[b->row[k] + 1]++;
            b->place[at] = (int)k;
            b->column[at] = j;
        }
    return 0;
}

static void close_block(block *b) {
    free(b->row_start);
    free(b->place);
    free(b->column);
    free(b->value);
}

/* out (rows, stride) = by_c dc + by_u (gradient directions) */
INLINE void explicit_part(const block *by_c, const block *by_u, const double *gradient, const right_side *p, double *out) {
    memset(out, 0, sizeof(double) * by_c->rows * p->stride);
    for (int j = 0; j < by_c->columns; j++)
        for (integer k = by_c->start[j]; k < by_c->start[j + 1]; k++) {
            double v = by_c->value[k], *row = out + (size_t)by_c->row[k] * p->stride;
            for (int i = p->start[j]; i < p->start[j + 1]; i++) row[p->column[i]] += v * p->value[i];
        }
    for (int j = 0; j < by_u->columns; j++)
        for (int d = 0; d < p->directions; d++) {
            double moved = gradient[j * p->directions + d];
            if (moved == 0.0) continue;
            const double *direction = p->direction + (size_t)d * p->columns;
            for (integer k = by_u->start[j]; k < by_u->start[j + 1]; k++) {
                double v = by_u->value[k] * moved, *row = out + (size_t)by_u->row[k] * p->stride;
                for (int i = 0; i < p->columns; i++) row[i] += v * direction[i];
            }
        }
}

/* sum (TILE) += row i of a block times the columns at `matrix`, (block's columns, stride) */
INLINE void add_row(const block *b, int i, const double *matrix, int stride, double *sum) {
    for (int k = b->row_start[i]; k < b->row_start[i + 1]; k++) {
        double v = b->value[b->place[k]];
        const double *row = matrix + (size_t)b->column[k] * stride;
        for (int t = 0; t < TILE; t++) sum[t] += v * row[t];
    }
}

/* LU of a (n, n), row by row, rows swapped; 0, or 1 where it is singular. */
INLINE int factor(int n, double *a, int *pivot) {
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(a[i * n + k]) > fabs(a[best * n + k])) best = i;
        pivot[k] = best;
        if (!(fabs(a[best * n + k]) > 0.0)) return 1;
        if (best != k)
            for (int j = 0; j < n; j++) {
                double t = a[k * n + j];
                a[k * n + j] = a[best * n + j];
                a[best * n + j] = t;
            }
        double inverse = 1.0 / a[k * n + k];
        for (int i = k + 1; i < n; i++) {
            double f = a[i * n + k] *= inverse;
            if (f != 0.0)
                for (int j = k + 1; j < n; j++) a[i * n + j] -= f * a[k * n + j];
        }
    }
    return 0;
}

/* TILE columns at x (n, stride): solved for in place. */
INLINE void solve_tile(int n, const double *a, const int *pivot, double *x, int stride) {
    double sum[TILE];
    for (int k = 0; k < n; k++)
        if (pivot[k] != k)
            for (int t = 0; t < TILE; t++) {
                double other = x[(size_t)k * stride + t];
                x[(size_t)k * stride + t] = x[(size_t)pivot[k] * stride + t];
                x[(size_t)pivot[k] * stride + t] = other;
            }
    for (int i = 1; i < n; i++) {
        for (int t = 0; t < TILE; t++) sum[t] = x[(size_t)i * stride + t];
        for (int k = 0; k < i; k++) {
            double f = a[i * n + k];
            if (f != 0.0)
                for (int t = 0; t < TILE; t++) sum[t] -= f * x[(size_t)k * stride + t];
        }
        for (int t = 0; t < TILE; t++) x[(size_t)i * stride + t] = sum[t];
    }
    for (int i = n - 1; i >= 0; i--) {
        double inverse = 1.0 / a[i * n + i];
        for (int t = 0; t < TILE; t++) sum[t] = x[(size_t)i * stride + t];
        for (int k = i + 1; k < n; k++) {
            double f = a[i * n + k];
            if (f != 0.0)
                for (int t = 0; t < TILE; t++) sum[t] -= f * x[(size_t)k * stride + t];
        }
        for (int t = 0; t < TILE; t++) x[(size_t)i * stride + t] = sum[t] * inverse;
    }
}

typedef struct {
    int nx, ny, nz;
    const double *scale;
    block *of;                          /* BLOCKS of them, with their numbers at the point */
    double *matrix, *dx, *dy, *dz, *dz_next;
    int *pivot;
} point;

/* One equilibrium: dx, dz_next, and dy if it is wanted. 0, or 1 where it is singular. */
FOR_THIS_PROCESSOR
static int differentiate(point *e, const right_side *p, const double *gradient, int wanted) {
    const block *of = e->of, *r_x = of + R_X;
    int n = e->nx, stride = p->stride;
    double sum[TILE];
    memset(e->matrix, 0, sizeof(double) * n * n);
    for (int j = 0; j < n; j++)
        for (integer k = r_x->start[j]; k < r_x->start[j + 1]; k++)
            e->matrix[r_x->row[k] * n + j] = r_x->value[k] / e->scale[r_x->row[k]];
    if (factor(n, e->matrix, e->pivot)) return 1;
    explicit_part(of + R_C, of + R_U, gradient, p, e->dx);
    if (wanted) explicit_part(of + Y_C, of + Y_U, gradient, p, e->dy);
    if (e->nz) explicit_part(of + Z_C, of + Z_U, gradient, p, e->dz_next);
    for (int first = 0; first < p->columns; first += TILE) {
        double *dx = e->dx + first;
        const double *dz = e->dz + first;
        for (int i = 0; i < n; i++) {
            double share = -1.0 / e->scale[i];
            for (int t = 0; t < TILE; t++) sum[t] = dx[(size_t)i * stride + t];
            if (e->nz) add_row(of + R_Z, i, dz, stride, sum);
            for (int t = 0; t < TILE; t++) dx[(size_t)i * stride + t] = share * sum[t];
        }
        solve_tile(n, e->matrix, e->pivot, dx, stride);
        for (int i = 0; wanted && i < e->ny; i++) {
            double *dy = e->dy + (size_t)i * stride + first;
            for (int t = 0; t < TILE; t++) sum[t] = dy[t];
            add_row(of + Y_X, i, dx, stride, sum);
            if (e->nz) add_row(of + Y_Z, i, dz, stride, sum);
            for (int t = 0; t < TILE; t++) dy[t] = sum[t];
        }
        for (int i = 0; i < e->nz; i++) {
            double *next = e->dz_next + (size_t)i * stride + first;
            for (int t = 0; t < TILE; t++) sum[t] = next[t];
            add_row(of + Z_X, i, dx, stride, sum);
            add_row(of + Z_Z, i, dz, stride, sum);
            for (int t = 0; t < TILE; t++) next[t] = sum[t];
        }
    }
    return 0;
}

static void copy_rows(int rows, int columns, const double *from, int from_stride, double *to, int to_stride) {
    for (int i = 0; i < rows; i++)
        memcpy(to + (size_t)i * to_stride, from + (size_t)i * from_stride, sizeof(double) * columns);
}

/* n equilibria x, u, after the friction states z, at constants c; they move with `columns` parameters by dc
   (rows of c, sparse) and du = gradient (n, nu, directions) direction (directions, columns).
   dy: (., ny, columns); place: the row there that each equilibrium goes to, below 0 for none.
   dx: (n, nx, columns), or NULL. dz: (nz, columns), before the first and then after the last.
   Returns 0, 1 + index of a singular equilibrium, or -1 without memory. */
int sensitivity(int nx, int nu, int nz, int ny, const double *scale, const double *c, int n, const double *x,
                const double *u, const double *z, int columns, const int *dc_start, const int *dc_column,
                const double *dc_value, int directions, const double *direction, const double *gradient,
                const int *place, double *dy, double *dx, double *dz) {
    int stride = (columns + TILE - 1) / TILE * TILE, count = nz ? BLOCKS : R_Z, failed = 0, closed = 0;
    right_side p = {columns, stride, dc_start, dc_column, dc_value, directions, direction};
    block of[BLOCKS];
    double *value[BLOCKS], *memory;
    size_t doubles = (size_t)nx * nx + (size_t)stride * (nx + ny + 2 * nz) + 8;
    memset(of, 0, sizeof(of));
    memory = calloc(doubles, sizeof(double));
    int *pivot = malloc(sizeof(int) * (nx + 1));
    for (int b = 0; b < count; b++) {
        closed |= open_block(of + b, b);
        value[b] = of[b].value;
    }
    if (!memory || !pivot || closed) failed = -1;
    if (!failed) {
        double *m = memory;
        point e = {nx, ny, nz, scale, of};
        e.pivot = pivot;
        e.dx = m; m += (size_t)stride * nx;
        e.dy = m; m += (size_t)stride * ny;
        e.dz = m; m += (size_t)stride * nz;
        e.dz_next = m; m += (size_t)stride * nz;
        e.matrix = m;
        copy_rows(nz, columns, dz, columns, e.dz, stride);
        for (int i = 0; i < n && !failed; i++) {
            const double *arg[4] = {x + (size_t)i * nx, c, u + (size_t)i * nu, z + (size_t)i * nz};
            derivatives(arg, value, 0, 0, 0);
            if (differentiate(&e, &p, gradient + (size_t)i * nu * directions, place[i] >= 0)) failed = i + 1;
            if (place[i] >= 0) copy_rows(ny, columns, e.dy, stride, dy + (size_t)place[i] * ny * columns, columns);
            if (dx) copy_rows(nx, columns, e.dx, stride, dx + (size_t)i * nx * columns, columns);
            double *before = e.dz;
            e.dz = e.dz_next;
            e.dz_next = before;
        }
        copy_rows(nz, columns, e.dz, stride, dz, columns);
    }
    for (int b = 0; b < count; b++) close_block(of + b);
    free(memory);
    free(pivot);
    return failed;
}
