/* Functions of a topology as straight-line programs, so that nothing has to be compiled for it: the functions that
   driver.c, batch.c and sensitivity.c call. OPERATIONS, which names each operation once, is generated; NUMBER is the
   type of all values: double, or a lane. */
#include <math.h>
#include <string.h>

typedef long long integer;

/* Arguments, constants and values lie at places in this order of arguments and constants; runs of one operation
   work through `operand` in turn. */
typedef struct {
    int inputs, runs, results;
    const int *size;                    /* (inputs) numbers of each argument */
    const int *run;                     /* (runs, 2) operation, and how often */
    const unsigned long long *operand;  /* (., 2) pairs of offsets, of a double each: of value and a, of b and c */
    const int *result;                  /* (results, 3) result, which number of it, its place */
    const integer *pattern;             /* of the results, compressed, one after the other */
    const int *pattern_start;
    NUMBER *place;
} program;

enum { RESIDUAL, JACOBIAN, OUTPUTS, STATE_UPDATE };

static _Thread_local const program *programs;

#define AT(offset) ((NUMBER *)((char *)place + (offset) * (sizeof(NUMBER) / sizeof(double))))
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#define FIRST(pair) ((pair) >> 32)
#define SECOND(pair) ((pair) & 0xffffffffu)
#else
#define FIRST(pair) ((pair) & 0xffffffffu)
#define SECOND(pair) ((pair) >> 32)
#endif

/* CasADi's number of an operation, or one beyond those, and its value from a, b and c. Operands are read in pairs:
   as many loads as the processor can do at a time are what a program waits for. */
#define OPERATION(code, value)                                                               \
    case code:                                                                               \
        for (int i = 0; i < count; i++, q += 2) {                                            \
            const NUMBER a = *AT(SECOND(q[0])), b = *AT(FIRST(q[1])), c = *AT(SECOND(q[1])); \
            (void)b;                                                                         \
            (void)c;                                                                         \
            *AT(FIRST(q[0])) = value;                                                        \
        }                                                                                    \
        break;

int run_program(const program *p, const NUMBER **argument, NUMBER **result) {
    NUMBER *place = p->place, *first = place;
    const unsigned long long *q = p->operand;
    for (int k = 0; k < p->inputs; k++) {
        if (p->size[k]) memcpy(first, argument[k], sizeof(NUMBER) * p->size[k]);
        first += p->size[k];
    }
    for (int r = 0; r < p->runs; r++) {
        const int count = p->run[2 * r + 1];
        switch (p->run[2 * r]) { OPERATIONS }
    }
    for (int k = 0; k < p->results; k++) {
        const int *to = p->result + 3 * k;
        result[to[0]][to[1]] = place[to[2]];
    }
    return 0;
}

int residual(const NUMBER **arg, NUMBER **res, integer *iw, NUMBER *w, int instance) {
    return run_program(programs + RESIDUAL, arg, res);
}

int jacobian(const NUMBER **arg, NUMBER **res, integer *iw, NUMBER *w, int instance) {
    return run_program(programs + JACOBIAN, arg, res);
}

int outputs(const NUMBER **arg, NUMBER **res, integer *iw, NUMBER *w, int instance) {
    return run_program(programs + OUTPUTS, arg, res);
}

int state_update(const NUMBER **arg, NUMBER **res, integer *iw, NUMBER *w, int instance) {
    return run_program(programs + STATE_UPDATE, arg, res);
}

int derivatives(const NUMBER **arg, NUMBER **res, integer *iw, NUMBER *w, int instance) {
    return run_program(programs, arg, res);
}

const integer *derivatives_sparsity_out(integer index) {
    return programs->pattern + programs->pattern_start[index];
}

/* What this thread's next call of `march` or `sensitivity` carries out: the four of a march in the order of the
   enumeration above, or the one of the derivatives. */
void use_programs(const program *chosen) {
    programs = chosen;
}
