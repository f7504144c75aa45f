/* The problems of src/studies/samples/equations.rs by CVODES and IDAS without pliant, as their user guides have it.
 *
 * Arguments: problem (hires, robertson, vanderpol, pollution, brusselator; amplifier by IDAS), linear solver (dense,
 * band, klu), number of runs. Prints the least time of a run in seconds, from the first object made to the last one
 * freed, and the counters of benches/overhead.rs. */

#define _GNU_SOURCE /* M_PI */

#include <cvodes/cvodes.h>
#include <idas/idas.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>
#include <time.h>

#include "equations.h"

#define CHECK(call) check((call) >= 0, #call)

static void check(int is_good, const char *what) {
    if (!is_good) { fprintf(stderr, "%s failed\n", what); exit(1); }
}

typedef struct {
    const char *name, *solver;
    int n, entries;
    const double *y0;
    double end;
    const double *atol; /* 1e-12 each, if null */
    CVRhsFn rhs;
    CVLsJacFn jacobian;
} problem_t;

static const double HIRES_Y0[] = {1, 0, 0, 0, 0, 0, 0, 0.0057};
static const double ROBERTSON_Y0[] = {1, 0, 0}, ROBERTSON_ATOL[] = {1e-14, 1e-19, 1e-10};
static const double VAN_DER_POL_Y0[] = {2, 0};

static const problem_t PROBLEMS[] = {
    {"hires", "dense", 8, 0, HIRES_Y0, 321.8122, NULL, hires, hires_dense},
    {"hires", "klu", 8, 25, HIRES_Y0, 321.8122, NULL, hires, hires_sparse},
    {"robertson", "dense", 3, 0, ROBERTSON_Y0, 4e10, ROBERTSON_ATOL, robertson, robertson_dense},
    {"vanderpol", "dense", 2, 0, VAN_DER_POL_Y0, 2000, NULL, van_der_pol, van_der_pol_dense},
    {"pollution", "dense", 20, 0, POLLUTION_Y0, 60, NULL, pollution, pollution_dense},
    {"brusselator", "band", 2 * POINTS, 0, BRUSSELATOR_Y0, 10, NULL, brusselator, brusselator_band},
    {"brusselator", "klu", 2 * POINTS, BRUSSELATOR_ENTRIES, BRUSSELATOR_Y0, 10, NULL, brusselator,
     brusselator_sparse},
};

enum { STEPS, EVALUATIONS, JACOBIANS, SETUPS, ERROR_TESTS, ITERATIONS, CONVERGENCE, COUNTERS };

static N_Vector vector(const double *values, int n, SUNContext context) {
    N_Vector vector = N_VNew_Serial(n, context);
    memcpy(NV_DATA_S(vector), values, n * sizeof(double));
    return vector;
}

static void run(const problem_t *problem, long counters[COUNTERS]) {
    SUNContext context;
    CHECK(SUNContext_Create(NULL, &context));
    N_Vector y = vector(problem->y0, problem->n, context), atol = N_VClone(y);
    for (int i = 0; i < problem->n; i++) NV_Ith_S(atol, i) = problem->atol ? problem->atol[i] : 1e-12;
    void *cvode = CVodeCreate(CV_BDF, context);
    CHECK(CVodeInit(cvode, problem->rhs, 0.0, y));
    CHECK(CVodeSVtolerances(cvode, 1e-8, atol));
    CHECK(CVodeSetMaxNumSteps(cvode, 100000));
    SUNMatrix matrix;
    SUNLinearSolver solver;
    if (!strcmp(problem->solver, "dense")) {
        matrix = SUNDenseMatrix(problem->n, problem->n, context);
        solver = SUNLinSol_Dense(y, matrix, context);
    } else if (!strcmp(problem->solver, "band")) {
        matrix = SUNBandMatrix(problem->n, 2, 2, context);
        solver = SUNLinSol_Band(y, matrix, context);
    } else {
        matrix = SUNSparseMatrix(problem->n, problem->n, problem->entries, CSC_MAT, context);
        solver = SUNLinSol_KLU(y, matrix, context);
        /* columns in the order of AMD, as pliant has them */
        CHECK(SUNLinSol_KLUSetOrdering(solver, 0));
    }
    CHECK(CVodeSetLinearSolver(cvode, solver, matrix));
    CHECK(CVodeSetJacFn(cvode, problem->jacobian));
    double t;
    CHECK(CVode(cvode, problem->end, y, &t, CV_NORMAL));
    CHECK(CVodeGetNumSteps(cvode, &counters[STEPS]));
    CHECK(CVodeGetNumRhsEvals(cvode, &counters[EVALUATIONS]));
    CHECK(CVodeGetNumJacEvals(cvode, &counters[JACOBIANS]));
    CHECK(CVodeGetNumLinSolvSetups(cvode, &counters[SETUPS]));
    CHECK(CVodeGetNumErrTestFails(cvode, &counters[ERROR_TESTS]));
    CHECK(CVodeGetNumNonlinSolvIters(cvode, &counters[ITERATIONS]));
    CHECK(CVodeGetNumNonlinSolvConvFails(cvode, &counters[CONVERGENCE]));
    CVodeFree(&cvode);
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
    N_VDestroy(atol);
    N_VDestroy(y);
    SUNContext_Free(&context);
}

static void run_amplifier(long counters[COUNTERS]) {
    SUNContext context;
    CHECK(SUNContext_Create(NULL, &context));
    N_Vector y = vector(AMPLIFIER_Y0, 8, context), yp = vector(AMPLIFIER_YP0, 8, context);
    void *ida = IDACreate(context);
    CHECK(IDAInit(ida, amplifier, 0.0, y, yp));
    CHECK(IDASStolerances(ida, 1e-5, 1e-5));
    CHECK(IDASetMaxNumSteps(ida, 100000));
    CHECK(IDASetMaxOrd(ida, 3));
    SUNMatrix matrix = SUNDenseMatrix(8, 8, context);
    SUNLinearSolver solver = SUNLinSol_Dense(y, matrix, context);
    CHECK(IDASetLinearSolver(ida, solver, matrix));
    CHECK(IDASetJacFn(ida, amplifier_dense));
    double t;
    CHECK(IDASolve(ida, 0.2, &t, y, yp, IDA_NORMAL));
    CHECK(IDAGetNumSteps(ida, &counters[STEPS]));
    CHECK(IDAGetNumResEvals(ida, &counters[EVALUATIONS]));
    CHECK(IDAGetNumJacEvals(ida, &counters[JACOBIANS]));
    CHECK(IDAGetNumLinSolvSetups(ida, &counters[SETUPS]));
    CHECK(IDAGetNumErrTestFails(ida, &counters[ERROR_TESTS]));
    CHECK(IDAGetNumNonlinSolvIters(ida, &counters[ITERATIONS]));
    CHECK(IDAGetNumNonlinSolvConvFails(ida, &counters[CONVERGENCE]));
    IDAFree(&ida);
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
    N_VDestroy(yp);
    N_VDestroy(y);
    SUNContext_Free(&context);
}

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec + 1e-9 * time.tv_nsec;
}

int main(int count, char **arguments) {
    check(count == 4, "reading the arguments problem, solver, runs");
    const problem_t *problem = PROBLEMS, *end = problem + sizeof PROBLEMS / sizeof *PROBLEMS;
    while (problem < end && (strcmp(problem->name, arguments[1]) || strcmp(problem->solver, arguments[2]))) {
        problem++;
    }
    int is_amplifier = !strcmp(arguments[1], "amplifier") && !strcmp(arguments[2], "dense");
    check(problem < end || is_amplifier, "looking the problem up");
    start_brusselator();
    double least = 1e9;
    long counters[COUNTERS];
    for (int runs = atoi(arguments[3]); runs > 0; runs--) {
        double start = now();
        if (is_amplifier) run_amplifier(counters);
        else run(problem, counters);
        double seconds = now() - start;
        if (seconds < least) least = seconds;
    }
    printf("%.9f", least);
    for (int c = 0; c < COUNTERS; c++) printf(" %ld", counters[c]);
    puts("");
    return 0;
}
