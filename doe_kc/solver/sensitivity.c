/* Derivatives of consecutive equilibria to parameters, by the implicit function theorem: the same algorithm as
   InterpretedDerivatives of derivatives.py. `derivatives`, a program, gives all blocks of as many points side by
   side as a vector register holds, see lanes.h: carrying it out for them takes hardly longer than for one. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef long long integer;

int derivatives(const lane **, lane **, integer *, lane *, int);
const integer *derivatives_sparsity_out(integer);

#define INLINE static inline __attribute__((always_inline))
#if defined(__AVX512F__)
#define PACK 8          /* columns of one vector register */
#elif defined(__AVX__)
#define PACK 4
#else
#define PACK 2
#endif
#define PACKS 8         /* registers of a tile: as many sums at once hide the latency of each */
#define TILE (PACKS * PACK) /* columns that are handled at once, in registers; what is left goes by fewer */

enum { R_X, R_C, R_U, Y_X, Y_C, Y_U, R_Z, Y_Z, Z_X, Z_C, Z_U, Z_Z, BLOCKS };

typedef double pack __attribute__((vector_size(8 * PACK), aligned(8)));
typedef struct { pack a, b, c, d, e, f, g, h; } tile; /* one row of `width` columns: the first width / PACK */

/* width: 1, 2, 4 or 8 of PACK, known where the functions are inlined. */
INLINE tile load(int width, const double *at) {
    const pack *p = (const pack *)at;
    tile s = {p[0]};
    if (width >= 2 * PACK) s.b = p[1];
    if (width >= 4 * PACK) s.c = p[2], s.d = p[3];
    if (width >= 8 * PACK) s.e = p[4], s.f = p[5], s.g = p[6], s.h = p[7];
    return s;
}

INLINE void store(int width, double *at, tile s) {
    pack *p = (pack *)at;
    p[0] = s.a;
    if (width >= 2 * PACK) p[1] = s.b;
    if (width >= 4 * PACK) p[2] = s.c, p[3] = s.d;
    if (width >= 8 * PACK) p[4] = s.e, p[5] = s.f, p[6] = s.g, p[7] = s.h;
}

/* s + v times the row at `at` */
INLINE tile add(int width, tile s, double v, const double *at) {
    const pack *p = (const pack *)at;
    s.a += v * p[0];
    if (width >= 2 * PACK) s.b += v * p[1];
    if (width >= 4 * PACK) s.c += v * p[2], s.d += v * p[3];
    if (width >= 8 * PACK) s.e += v * p[4], s.f += v * p[5], s.g += v * p[6], s.h += v * p[7];
    return s;
}

INLINE tile times(int width, double v, tile s) {
    s.a *= v;
    if (width >= 2 * PACK) s.b *= v;
    if (width >= 4 * PACK) s.c *= v, s.d *= v;
    if (width >= 8 * PACK) s.e *= v, s.f *= v, s.g *= v, s.h *= v;
    return s;
}

/* Numbers of a sparse matrix row by row. */
typedef struct {
    int *start, *column;
    double *value;
} by_rows;

/* A sparse block: its numbers column by column as generated code gives them, and row by row. */
typedef struct {
    int rows, columns;
    const integer *start, *row;         /* by column */
    double *value;
    int *place;                         /* of each number of `ordered` in `value` */
    by_rows ordered;
} block;

/* dc and the directions of the controls, cut into columns that are handled at once. */
typedef struct {
    int columns, padded;                /* padded: to whole tiles, the last of as few registers as hold it */
    int directions;
    by_rows dc;                         /* what is not zero, tile after tile; columns within their tile */
    int *dc_row;                        /* of dc, of each of these numbers */
    double *direction;                  /* (directions, padded) */
    double du[TILE];                    /* of one control */
} right_side;

INLINE int width_at(const right_side *p, int first) {
    int left = p->columns - first, width = PACK;
    while (width < TILE && width < left) width *= 2;
    return width;
}

static int open_rows(by_rows *r, int rows, int count) {
    r->start = calloc(rows + 2, sizeof(int));
    r->column = malloc(sizeof(int) * (count + 1));
    r->value = malloc(sizeof(double) * (count + 1));
    return !r->start || !r->column || !r->value;
}

static void close_rows(by_rows *r) {
    free(r->start);
    free(r->column);
    free(r->value);
}

static int open_block(block *b, int index) {
    const integer *pattern = derivatives_sparsity_out(index);
    b->rows = (int)pattern[0];
    b->columns = (int)pattern[1];
    b->start = pattern + 2;
    b->row = b->start + b->columns + 1;
    int count = (int)b->start[b->columns];
    b->place = malloc(sizeof(int) * (count + 1));
    b->value = malloc(sizeof(double) * (count + 1));
    if (open_rows(&b->ordered, b->rows, count) || !b->place || !b->value) return 1;
    int *start = b->ordered.start;
    for (int k = 0; k < count; k++) start[b->row[k] + 2]++;
    for (int i = 0; i < b->rows; i++) start[i + 2] += start[i + 1];
    for (int j = 0; j < b->columns; j++)
        for (integer k = b->start[j]; k < b->start[j + 1]; k++) {
            int at = start[b->row[k] + 1]++;
            b->place[at] = (int)k;
            b->ordered.column[at] = j;
        }
    return 0;
}

static void close_block(block *b) {
    close_rows(&b->ordered);
    free(b->place);
    free(b->value);
}

static int open_right_side(right_side *p, int columns, int rows, const int *start, const int *column,
                           const double *value, int directions, const double *direction) {
    p->columns = columns;
    p->padded = 0;
    while (p->padded < columns) p->padded += width_at(p, p->padded);
    p->directions = directions;
    p->direction = calloc((size_t)directions * p->padded + 1, sizeof(double));
    p->dc_row = malloc(sizeof(int) * (start[rows] + 1));
    if (open_rows(&p->dc, p->padded / PACK, start[rows]) || !p->direction || !p->dc_row) return 1;
    for (int d = 0; d < directions; d++)
        memcpy(p->direction + (size_t)d * p->padded, direction + (size_t)d * columns, sizeof(double) * columns);
    int *end = p->dc.start, at = 0;
    for (int first = 0; first < p->padded; first += width_at(p, first)) {
        for (int j = 0; j < rows; j++)
            for (int i = start[j]; i < start[j + 1]; i++)
                if (column[i] >= first && column[i] < first + width_at(p, first)) {
                    p->dc_row[at] = j;
                    p->dc.column[at] = column[i] - first;
                    p->dc.value[at++] = value[i];
                }
        *++end = at;
    }
    return 0;
}

static void close_right_side(right_side *p) {
    close_rows(&p->dc);
    free(p->dc_row);
    free(p->direction);
}

/* out (rows, width) = columns `first` on, the tile of that number, of by_c dc + by_u (gradient directions) */
INLINE void explicit_part(int width, const block *by_c, const block *by_u, const double *gradient, right_side *p,
                          int number, int first, double *out) {
    memset(out, 0, sizeof(double) * by_c->rows * width);
    for (int i = p->dc.start[number]; i < p->dc.start[number + 1]; i++) {
        int j = p->dc_row[i];
        double v = p->dc.value[i], *column = out + p->dc.column[i];
        for (integer k = by_c->start[j]; k < by_c->start[j + 1]; k++)
            column[by_c->row[k] * width] += by_c->value[k] * v;
    }
    for (int j = 0; j < by_u->columns; j++) {
        int moves = 0;
        for (int d = 0; d < p->directions; d++) {
            double moved = gradient[j * p->directions + d];
            if (moved == 0.0) continue;
            if (!moves) memset(p->du, 0, sizeof(p->du));
            store(width, p->du, add(width, load(width, p->du), moved, p->direction + (size_t)d * p->padded + first));
            moves = 1;
        }
        if (!moves) continue;
        for (integer k = by_u->start[j]; k < by_u->start[j + 1]; k++) {
            double *row = out + by_u->row[k] * width;
            store(width, row, add(width, load(width, row), by_u->value[k], p->du));
        }
    }
}

/* s + row i of a matrix times the rows at `rows` (., width) */
INLINE tile add_row(int width, tile s, const by_rows *m, int i, const double *rows) {
    for (int k = m->start[i]; k < m->start[i + 1]; k++)
        s = add(width, s, m->value[k], rows + m->column[k] * width);
    return s;
}

#define PIVOT_THRESHOLD 0.1     /* as in driver.c */

/* LU of a (n, n), row by row; order: the row that stands in each place, and then the one that came to it. Rows are
   swapped only where the diagonal is small in its column. 0, or 1 where it is singular. */
INLINE int factor(int n, double *a, int *order) {
    for (int k = 0; k < n; k++) {
        int best = k, first = k + 1, end = n;
        for (int i = k + 1; i < n; i++)
            if (fabs(a[i * n + k]) > fabs(a[best * n + k])) best = i;
        if (fabs(a[k * n + k]) >= PIVOT_THRESHOLD * fabs(a[best * n + k])) best = k;
        if (!(fabs(a[best * n + k]) > 0.0)) return 1;
        if (best != k) {
            int other = order[k];
            order[k] = order[best];
            order[best] = other;
            for (int j = 0; j < n; j++) {
                double t = a[k * n + j];
                a[k * n + j] = a[best * n + j];
                a[best * n + j] = t;
            }
        }
        double inverse = 1.0 / a[k * n + k];
        while (end > first && a[k * n + end - 1] == 0.0) end--;
        while (first < end && a[k * n + first] == 0.0) first++;
        for (int i = k + 1; i < n; i++) {
            if (a[i * n + k] == 0.0) continue;
            double f = a[i * n + k] *= inverse;
            for (int j = first; j < end; j++) a[i * n + j] -= f * a[k * n + j];
        }
    }
    return 0;
}

/* Minus what is not zero of rows below, then above the diagonal of a (n, n): rows 0 to n - 1, and n to 2 n - 1.
   pair: the unknown of each column. */
INLINE void compress(int n, const double *a, const int *pair, by_rows *out) {
    int at = 0;
    for (int half = 0; half < 2; half++)
        for (int i = 0; i < n; i++) {
            for (int j = half ? i + 1 : 0; j < (half ? n : i); j++)
                if (a[i * n + j] != 0.0) {
                    out->column[at] = pair[j];
                    out->value[at++] = -a[i * n + j];
                }
            out->start[half * n + i + 1] = at;
        }
}

typedef struct {
    int nx, ny, nz;
    int kept_count;
    const int *kept;                    /* (kept_count) outputs that are asked for */
    const double *scale;
    const int *pair;                    /* (nx) equation and unknown that are eliminated together */
    block *of;                          /* BLOCKS of them, with their numbers at the point */
    double *matrix;                     /* (nx, nx), factorized */
    int *order, *at;                    /* equation that came to each place; place of each pair */
    by_rows factors;                    /* of `matrix`, see `compress` */
    double *right, *dx, *dy, *dz_next;  /* (., TILE) of one tile */
    double *dz;                         /* (nz, padded), tile after tile */
} point;

/* The columns of one tile: dz, and where they are wanted dy and dx, columns `first` on of (., columns). */
INLINE void differentiate_tile(int width, point *e, right_side *p, const double *gradient, int number,
                               int first, double *dy, double *dx) {
    const block *of = e->of;
    int n = e->nx, count = p->columns - first < width ? p->columns - first : width;
    double *dz = e->dz + (size_t)e->nz * first;
    explicit_part(width, of + R_C, of + R_U, gradient, p, number, first, e->right);
    for (int i = 0; i < n; i++) {
        int from = e->order[i];
        tile s = load(width, e->right + from * width);
        if (e->nz) s = add_row(width, s, &of[R_Z].ordered, from, dz);
        s = times(width, -1.0 / e->scale[from], s);
        store(width, e->dx + e->pair[i] * width, add_row(width, s, &e->factors, i, e->dx));
    }
    for (int i = n - 1; i >= 0; i--) {
        double *row = e->dx + e->pair[i] * width;
        tile s = add_row(width, load(width, row), &e->factors, n + i, e->dx);
        store(width, row, times(width, 1.0 / e->matrix[i * n + i], s));
        if (dx) memcpy(dx + (size_t)e->pair[i] * p->columns + first, row, sizeof(double) * count);
    }
    if (dy) {
        explicit_part(width, of + Y_C, of + Y_U, gradient, p, number, first, e->dy);
        for (int k = 0; k < e->kept_count; k++) {
            double *row = e->dy + e->kept[k] * width;
            tile s = add_row(width, load(width, row), &of[Y_X].ordered, e->kept[k], e->dx);
            if (e->nz) s = add_row(width, s, &of[Y_Z].ordered, e->kept[k], dz);
            store(width, row, s);
            memcpy(dy + (size_t)k * p->columns + first, row, sizeof(double) * count);
        }
    }
    if (!e->nz) return;
    explicit_part(width, of + Z_C, of + Z_U, gradient, p, number, first, e->dz_next);
    for (int i = 0; i < e->nz; i++) {
        tile s = add_row(width, load(width, e->dz_next + i * width), &of[Z_X].ordered, i, e->dx);
        store(width, e->dz_next + i * width, add_row(width, s, &of[Z_Z].ordered, i, dz));
    }
    memcpy(dz, e->dz_next, sizeof(double) * e->nz * width);
}

/* One equilibrium; dy (kept_count, columns), dx (nx, columns): where they are wanted. 0, or 1 where it is
   singular. */
static int differentiate(point *e, right_side *p, const double *gradient, double *dy, double *dx) {
    const block *r_x = e->of + R_X;
    int n = e->nx;
    memset(e->matrix, 0, sizeof(double) * n * n);
    for (int j = 0; j < n; j++)
        for (integer k = r_x->start[j]; k < r_x->start[j + 1]; k++)
            e->matrix[e->at[r_x->row[k]] * n + e->at[j]] = r_x->value[k] / e->scale[r_x->row[k]];
    memcpy(e->order, e->pair, sizeof(int) * n);
    if (factor(n, e->matrix, e->order)) return 1;
    compress(n, e->matrix, e->pair, &e->factors);
    static const int used[] = {Y_X, R_Z, Y_Z, Z_X, Z_Z};
    for (int index = 0; index < (e->nz ? 5 : 1); index++) {
        block *b = e->of + used[index];
        int numbers = b->ordered.start[b->rows];
        for (int k = 0; k < numbers; k++) b->ordered.value[k] = b->value[b->place[k]];
    }
    for (int first = 0, number = 0; first < p->padded; first += width_at(p, first), number++) {
        switch (width_at(p, first) / PACK) {
        case 8: differentiate_tile(8 * PACK, e, p, gradient, number, first, dy, dx); break;
        case 4: differentiate_tile(4 * PACK, e, p, gradient, number, first, dy, dx); break;
        case 2: differentiate_tile(2 * PACK, e, p, gradient, number, first, dy, dx); break;
        default: differentiate_tile(PACK, e, p, gradient, number, first, dy, dx);
        }
    }
    return 0;
}

/* Arguments and blocks of LANES points side by side. */
typedef struct {
    lane *argument[4], *value[BLOCKS];
    int count[4];                       /* of each argument's numbers */
} side_by_side;

static int open_points(side_by_side *s, const int *count, const block *of, int blocks) {
    int closed = 0;
    memset(s, 0, sizeof(*s));
    for (int k = 0; k < 4; k++) {
        s->count[k] = count[k];
        closed |= !(s->argument[k] = aligned_alloc(sizeof(lane), sizeof(lane) * (count[k] + 1)));
    }
    for (int b = 0; b < blocks; b++)
        closed |= !(s->value[b] = aligned_alloc(sizeof(lane), sizeof(lane) * (of[b].start[of[b].columns] + 1)));
    return closed;
}

static void close_points(side_by_side *s) {
    for (int k = 0; k < 4; k++) free(s->argument[k]);
    for (int b = 0; b < BLOCKS; b++) free(s->value[b]);
}

/* All blocks at the points `first` on, of n; given: (n, .) of each argument, (1, .) of the constants, the second. */
static void evaluate_points(side_by_side *s, const double *const *given, int first, int n) {
    for (int k = 0; k < 4; k++)
        for (int l = 0; l < LANES; l++) {
            int at = k == 1 ? 0 : first + l < n ? first + l : n - 1;
            const double *row = given[k] + (size_t)at * s->count[k];
            double *to = (double *)s->argument[k] + l;
            for (int i = 0; i < s->count[k]; i++) to[(size_t)i * LANES] = row[i];
        }
    derivatives((const lane **)s->argument, s->value, 0, 0, 0);
}

/* The friction states' derivatives, (nz, columns) as the caller holds them, to or from tile after tile. */
static void copy_states(const right_side *p, int nz, double *rows, double *tiles, int to_tiles) {
    for (int first = 0; first < p->padded; first += width_at(p, first)) {
        int width = width_at(p, first), count = p->columns - first < width ? p->columns - first : width;
        for (int i = 0; i < nz; i++) {
            double *row = rows + (size_t)i * p->columns + first, *of_tile = tiles + (size_t)nz * first + i * width;
            memcpy(to_tiles ? of_tile : row, to_tiles ? row : of_tile, sizeof(double) * count);
        }
    }
}

/* pair: (nx) equation and unknown that are eliminated together, in this order.
   n equilibria x, u, after the friction states z, at constants c; they move with `columns` parameters by dc
   (rows of c, sparse) and du = gradient (n, nu, directions) direction (directions, columns).
   kept: (kept_count) outputs that are asked for. dy: (., kept_count, columns); place: the row there that each
   equilibrium goes to, below 0 for none.
   dx: (n, nx, columns), or NULL. dz: (nz, columns), before the first and then after the last.
   Returns 0, 1 + index of a singular equilibrium, or -1 without memory. */
int sensitivity(int nx, int nu, int nz, int ny, const double *scale, const int *pair, const double *c, int n, const double *x,
                const double *u, const double *z, int columns, const int *dc_start, const int *dc_column,
                const double *dc_value, int directions, const double *direction, const double *gradient,
                int kept_count, const int *kept, const int *place, double *dy, double *dx, double *dz) {
    int count = nz ? BLOCKS : R_Z, failed = 0, closed = 0;
    block of[BLOCKS];
    side_by_side points;
    right_side p;
    point e = {nx, ny, nz, kept_count, kept, scale, pair, of};
    memset(of, 0, sizeof(of));
    for (int b = 0; b < count; b++) closed |= open_block(of + b, b);
    const int nc = of[R_C].columns, sizes[4] = {nx, nc, nu, nz};
    closed |= open_points(&points, sizes, of, count);
    closed |= open_right_side(&p, columns, of[R_C].columns, dc_start, dc_column, dc_value, directions, direction);
    closed |= open_rows(&e.factors, 2 * nx, nx * nx);
    double *memory = calloc((size_t)nx * nx + (size_t)TILE * (2 * nx + ny + nz) + (size_t)nz * p.padded + 1, sizeof(double));
    e.order = malloc(sizeof(int) * 2 * (nx + 1));
    if (closed || !memory || !e.order) failed = -1;
    if (!failed) {
        e.at = e.order + nx;
        for (int k = 0; k < nx; k++) e.at[pair[k]] = k;
        e.matrix = memory;
        e.right = e.matrix + (size_t)nx * nx;
        e.dx = e.right + TILE * nx;
        e.dy = e.dx + TILE * nx;
        e.dz_next = e.dy + TILE * ny;
        e.dz = e.dz_next + TILE * nz;
        copy_states(&p, nz, dz, e.dz, 1);
        const double *given[4] = {x, c, u, z};
        for (int i = 0; i < n && !failed; i++) {
            if (i % LANES == 0) evaluate_points(&points, given, i, n);
            for (int b = 0; b < count; b++) {
                const double *from = (const double *)points.value[b] + i % LANES;
                integer numbers = of[b].start[of[b].columns];
                for (integer k = 0; k < numbers; k++) of[b].value[k] = from[k * LANES];
            }
            double *own_y = place[i] >= 0 ? dy + (size_t)place[i] * kept_count * columns : NULL;
            double *own_x = dx ? dx + (size_t)i * nx * columns : NULL;
            if (differentiate(&e, &p, gradient + (size_t)i * nu * directions, own_y, own_x)) failed = i + 1;
        }
        copy_states(&p, nz, dz, e.dz, 0);
    }
    for (int b = 0; b < count; b++) close_block(of + b);
    close_points(&points);
    close_right_side(&p);
    close_rows(&e.factors);
    free(memory);
    free(e.order);
    return failed;
}
