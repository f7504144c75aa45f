/* The problems of src/samples/equations.rs by CVODES without pliant, as its user guide has it.
 *
 * Arguments: problem (hires, robertson, vanderpol), linear solver (dense, klu), number of runs.
 * Prints the least time of a run in seconds, from the first object made to the last one freed, and
 * the counters of benches/overhead.rs. */

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>
#include <time.h>

#define CHECK(call) check((call) >= 0, #call)
#define MOST 8

static void check(int is_good, const char *what) {
    if (!is_good) { fprintf(stderr, "%s failed\n", what); exit(1); }
}

static int hires(realtype t, N_Vector vector, N_Vector derivative, void *data) {
    const double *y = NV_DATA_S(vector);
    double *ydot = NV_DATA_S(derivative), exchange = 280.0 * y[5] * y[7];
    ydot[0] = -1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + 0.0007;
    ydot[1] = 1.71 * y[0] - 8.75 * y[1];
    ydot[2] = -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4];
    ydot[3] = 8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3];
    ydot[4] = -1.745 * y[4] + 0.43 * (y[5] + y[6]);
    ydot[5] = -exchange + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6];
    ydot[6] = exchange - 1.81 * y[6];
    ydot[7] = -ydot[6];
    return 0;
}

static int hires_dense(realtype t, N_Vector vector, N_Vector derivative, SUNMatrix matrix, void *data,
                       N_Vector a, N_Vector b, N_Vector c) {
    const double *y = NV_DATA_S(vector);
    SM_ELEMENT_D(matrix, 0, 0) = -1.71;
    SM_ELEMENT_D(matrix, 0, 1) = 0.43;
    SM_ELEMENT_D(matrix, 0, 2) = 8.32;
    SM_ELEMENT_D(matrix, 1, 0) = 1.71;
    SM_ELEMENT_D(matrix, 1, 1) = -8.75;
    SM_ELEMENT_D(matrix, 2, 2) = -10.03;
    SM_ELEMENT_D(matrix, 2, 3) = 0.43;
    SM_ELEMENT_D(matrix, 2, 4) = 0.035;
    SM_ELEMENT_D(matrix, 3, 1) = 8.32;
    SM_ELEMENT_D(matrix, 3, 2) = 1.71;
    SM_ELEMENT_D(matrix, 3, 3) = -1.12;
    SM_ELEMENT_D(matrix, 4, 4) = -1.745;
    SM_ELEMENT_D(matrix, 4, 5) = 0.43;
    SM_ELEMENT_D(matrix, 4, 6) = 0.43;
    SM_ELEMENT_D(matrix, 5, 3) = 0.69;
    SM_ELEMENT_D(matrix, 5, 4) = 1.71;
    SM_ELEMENT_D(matrix, 5, 5) = -280.0 * y[7] - 0.43;
    SM_ELEMENT_D(matrix, 5, 6) = 0.69;
    SM_ELEMENT_D(matrix, 5, 7) = -280.0 * y[5];
    SM_ELEMENT_D(matrix, 6, 5) = 280.0 * y[7];
    SM_ELEMENT_D(matrix, 6, 6) = -1.81;
    SM_ELEMENT_D(matrix, 6, 7) = 280.0 * y[5];
    SM_ELEMENT_D(matrix, 7, 5) = -280.0 * y[7];
    SM_ELEMENT_D(matrix, 7, 6) = 1.81;
    SM_ELEMENT_D(matrix, 7, 7) = -280.0 * y[5];
    return 0;
}

/* Starts of the columns and rows of the entries, column by column. */
static const sunindextype HIRES_STARTS[] = {0, 2, 5, 8, 11, 14, 18, 22, 25};
static const sunindextype HIRES_ROWS[] = {0, 1, 0, 1, 3, 0, 2, 3, 2, 3, 5, 2, 4, 5,
                                          4, 5, 6, 7, 4, 5, 6, 7, 5, 6, 7};

static int hires_sparse(realtype t, N_Vector vector, N_Vector derivative, SUNMatrix matrix, void *data,
                        N_Vector a, N_Vector b, N_Vector c) {
    const double *y = NV_DATA_S(vector);
    const double values[] = {
        -1.71, 1.71, 0.43, -8.75, 8.32, 8.32, -10.03, 1.71, 0.43, -1.12, 0.69, 0.035, -1.745, 1.71,
        0.43, -280.0 * y[7] - 0.43, 280.0 * y[7], -280.0 * y[7], 0.43, 0.69, -1.81, 1.81,
        -280.0 * y[5], 280.0 * y[5], -280.0 * y[5]};
    memcpy(SM_INDEXPTRS_S(matrix), HIRES_STARTS, sizeof HIRES_STARTS);
    memcpy(SM_INDEXVALS_S(matrix), HIRES_ROWS, sizeof HIRES_ROWS);
    memcpy(SM_DATA_S(matrix), values, sizeof values);
    return 0;
}

static int robertson(realtype t, N_Vector vector, N_Vector derivative, void *data) {
    const double *y = NV_DATA_S(vector);
    double *ydot = NV_DATA_S(derivative);
    ydot[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
    ydot[2] = 3e7 * y[1] * y[1];
    ydot[1] = -ydot[0] - ydot[2];
    return 0;
}

static int robertson_dense(realtype t, N_Vector vector, N_Vector derivative, SUNMatrix matrix,
                           void *data, N_Vector a, N_Vector b, N_Vector c) {
    const double *y = NV_DATA_S(vector);
    SM_ELEMENT_D(matrix, 0, 0) = -0.04;
    SM_ELEMENT_D(matrix, 0, 1) = 1e4 * y[2];
    SM_ELEMENT_D(matrix, 0, 2) = 1e4 * y[1];
    SM_ELEMENT_D(matrix, 1, 0) = 0.04;
    SM_ELEMENT_D(matrix, 1, 1) = -1e4 * y[2] - 6e7 * y[1];
    SM_ELEMENT_D(matrix, 1, 2) = -1e4 * y[1];
    SM_ELEMENT_D(matrix, 2, 1) = 6e7 * y[1];
    return 0;
}

static int van_der_pol(realtype t, N_Vector vector, N_Vector derivative, void *data) {
    const double *y = NV_DATA_S(vector);
    double *ydot = NV_DATA_S(derivative);
    ydot[0] = y[1];
    ydot[1] = 1000.0 * (1.0 - y[0] * y[0]) * y[1] - y[0];
    return 0;
}

static int van_der_pol_dense(realtype t, N_Vector vector, N_Vector derivative, SUNMatrix matrix,
                             void *data, N_Vector a, N_Vector b, N_Vector c) {
    const double *y = NV_DATA_S(vector);
    SM_ELEMENT_D(matrix, 0, 1) = 1.0;
    SM_ELEMENT_D(matrix, 1, 0) = -2000.0 * y[0] * y[1] - 1.0;
    SM_ELEMENT_D(matrix, 1, 1) = 1000.0 * (1.0 - y[0] * y[0]);
    return 0;
}

typedef struct {
    const char *name, *solver;
    int n;
    double y0[MOST], end, atol[MOST];
    CVRhsFn rhs;
    CVLsJacFn jacobian;
} problem_t;

#define EIGHT {1e-12, 1e-12, 1e-12, 1e-12, 1e-12, 1e-12, 1e-12, 1e-12}

static const problem_t PROBLEMS[] = {
    {"hires", "dense", 8, {1, 0, 0, 0, 0, 0, 0, 0.0057}, 321.8122, EIGHT, hires, hires_dense},
    {"hires", "klu", 8, {1, 0, 0, 0, 0, 0, 0, 0.0057}, 321.8122, EIGHT, hires, hires_sparse},
    {"robertson", "dense", 3, {1, 0, 0}, 4e10, {1e-14, 1e-19, 1e-10}, robertson, robertson_dense},
    {"vanderpol", "dense", 2, {2, 0}, 2000, {1e-12, 1e-12}, van_der_pol, van_der_pol_dense},
};

enum { STEPS, EVALUATIONS, JACOBIANS, SETUPS, ERROR_TESTS, ITERATIONS, CONVERGENCE, COUNTERS };

static void run(const problem_t *problem, long counters[COUNTERS]) {
    SUNContext context;
    CHECK(SUNContext_Create(NULL, &context));
    N_Vector y = N_VNew_Serial(problem->n, context), atol = N_VClone(y);
    memcpy(NV_DATA_S(y), problem->y0, problem->n * sizeof(double));
    memcpy(NV_DATA_S(atol), problem->atol, problem->n * sizeof(double));
    void *cvode = CVodeCreate(CV_BDF, context);
    CHECK(CVodeInit(cvode, problem->rhs, 0.0, y));
    CHECK(CVodeSVtolerances(cvode, 1e-8, atol));
    CHECK(CVodeSetMaxNumSteps(cvode, 100000));
    int is_dense = strcmp(problem->solver, "dense") == 0;
    SUNMatrix matrix = is_dense
        ? SUNDenseMatrix(problem->n, problem->n, context)
        : SUNSparseMatrix(problem->n, problem->n, HIRES_STARTS[problem->n], CSC_MAT, context);
    SUNLinearSolver solver =
        is_dense ? SUNLinSol_Dense(y, matrix, context) : SUNLinSol_KLU(y, matrix, context);
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

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec + 1e-9 * time.tv_nsec;
}

int main(int count, char **arguments) {
    check(count == 4, "reading the arguments problem, solver, runs");
    for (size_t k = 0; k < sizeof PROBLEMS / sizeof *PROBLEMS; k++) {
        const problem_t *problem = &PROBLEMS[k];
        if (strcmp(problem->name, arguments[1]) || strcmp(problem->solver, arguments[2])) continue;
        double least = 1e9;
        long counters[COUNTERS];
        for (int runs = atoi(arguments[3]); runs > 0; runs--) {
            double start = now();
            run(problem, counters);
            double seconds = now() - start;
            if (seconds < least) least = seconds;
        }
        printf("%.9f", least);
        for (int c = 0; c < COUNTERS; c++) printf(" %ld", counters[c]);
        puts("");
        return 0;
    }
    check(0, "looking the problem up");
}
