/* Problems of src/studies/samples/equations.rs: right-hand sides and Jacobians, with the order of operations that they have there. */

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

/* Species are counted from 0. */
typedef struct {
    double constant;
    int factors, factor[2], changes;
    struct { int species; double amount; } change[5];
} reaction_t;

static const reaction_t REACTIONS[] = {
    {0.35, 1, {0}, 3, {{0, -1}, {1, 1}, {2, 1}}},
    {26.6, 2, {1, 3}, 3, {{0, 1}, {1, -1}, {3, -1}}},
    {1.23e4, 2, {4, 1}, 4, {{0, 1}, {1, -1}, {4, -1}, {5, 1}}},
    {8.6e-4, 1, {6}, 3, {{4, 2}, {6, -1}, {7, 1}}},
    {8.2e-4, 1, {6}, 2, {{6, -1}, {7, 1}}},
    {1.5e4, 2, {6, 5}, 4, {{4, 1}, {5, -1}, {6, -1}, {7, 1}}},
    {1.3e-4, 1, {8}, 4, {{4, 1}, {7, 1}, {8, -1}, {9, 1}}},
    {2.4e4, 2, {8, 5}, 3, {{5, -1}, {8, -1}, {10, 1}}},
    {1.65e4, 2, {10, 1}, 5, {{0, 1}, {1, -1}, {9, 1}, {10, -1}, {11, 1}}},
    {9e3, 2, {10, 0}, 3, {{0, -1}, {10, -1}, {12, 1}}},
    {0.022, 1, {12}, 3, {{0, 1}, {10, 1}, {12, -1}}},
    {1.2e4, 2, {9, 1}, 4, {{0, 1}, {1, -1}, {9, -1}, {13, 1}}},
    {1.88, 1, {13}, 3, {{4, 1}, {6, 1}, {13, -1}}},
    {1.63e4, 2, {0, 5}, 3, {{0, -1}, {5, -1}, {14, 1}}},
    {4.8e6, 1, {2}, 2, {{2, -1}, {3, 1}}},
    {3.5e-4, 1, {3}, 2, {{3, -1}, {15, 1}}},
    {0.0175, 1, {3}, 2, {{2, 1}, {3, -1}}},
    {1e8, 1, {15}, 2, {{5, 2}, {15, -1}}},
    {4.44e11, 1, {15}, 2, {{2, 1}, {15, -1}}},
    {1240.0, 2, {16, 5}, 4, {{4, 1}, {5, -1}, {16, -1}, {17, 1}}},
    {2.1, 1, {18}, 2, {{1, 1}, {18, -1}}},
    {5.78, 1, {18}, 3, {{0, 1}, {2, 1}, {18, -1}}},
    {0.0474, 2, {0, 3}, 3, {{0, -1}, {3, -1}, {18, 1}}},
    {1780.0, 2, {18, 0}, 3, {{0, -1}, {18, -1}, {19, 1}}},
    {3.12, 1, {19}, 3, {{0, 1}, {18, 1}, {19, -1}}},
};
#define EACH_REACTION(r) const reaction_t *r = REACTIONS; r < REACTIONS + 25; r++

static const double POLLUTION_Y0[20] =
    {[1] = 0.2, [3] = 0.04, [6] = 0.1, [7] = 0.3, [8] = 0.01, [16] = 0.007};

static int pollution(realtype t, N_Vector vector, N_Vector derivative, void *data) {
    const double *y = NV_DATA_S(vector);
    double *ydot = NV_DATA_S(derivative);
    memset(ydot, 0, 20 * sizeof *ydot);
    for (EACH_REACTION(r)) {
        double rate = r->constant;
        for (int k = 0; k < r->factors; k++) rate *= y[r->factor[k]];
        for (int k = 0; k < r->changes; k++) ydot[r->change[k].species] += r->change[k].amount * rate;
    }
    return 0;
}

static int pollution_dense(realtype t, N_Vector vector, N_Vector derivative, SUNMatrix matrix,
                           void *data, N_Vector a, N_Vector b, N_Vector c) {
    const double *y = NV_DATA_S(vector);
    for (EACH_REACTION(r)) {
        for (int k = 0; k < r->factors; k++) {
            double slope = r->constant;
            if (r->factors == 2) slope *= y[r->factor[1 - k]];
            for (int l = 0; l < r->changes; l++) {
                SM_ELEMENT_D(matrix, r->change[l].species, r->factor[k]) += r->change[l].amount * slope;
            }
        }
    }
    return 0;
}

#define POINTS 20
#define EXCHANGE ((POINTS + 1.0) * (POINTS + 1.0) / 50.0)

static double BRUSSELATOR_Y0[2 * POINTS];

static void start_brusselator(void) {
    for (int i = 0; i < POINTS; i++) {
        BRUSSELATOR_Y0[2 * i] = 1.0 + sin(2.0 * M_PI * ((i + 1.0) / (POINTS + 1.0)));
        BRUSSELATOR_Y0[2 * i + 1] = 3.0;
    }
}

static int brusselator(realtype t, N_Vector vector, N_Vector derivative, void *data) {
    const double *y = NV_DATA_S(vector), c = EXCHANGE;
    double *ydot = NV_DATA_S(derivative);
    for (int i = 0; i < POINTS; i++) {
        int is_first = i == 0, is_last = i == POINTS - 1;
        double u = y[2 * i], v = y[2 * i + 1];
        double left_u = is_first ? 1.0 : y[2 * i - 2], left_v = is_first ? 3.0 : y[2 * i - 1];
        double right_u = is_last ? 1.0 : y[2 * i + 2], right_v = is_last ? 3.0 : y[2 * i + 3];
        ydot[2 * i] = 1.0 + u * u * v - 4.0 * u + c * (left_u - 2.0 * u + right_u);
        ydot[2 * i + 1] = 3.0 * u - u * u * v + c * (left_v - 2.0 * v + right_v);
    }
    return 0;
}

/* The four entries of rows and columns 2 i and 2 i + 1, row by row. */
static void brusselator_point(const double *y, int i, double entries[4]) {
    double u = y[2 * i], v = y[2 * i + 1], c = EXCHANGE;
    entries[0] = 2.0 * u * v - 4.0 - 2.0 * c;
    entries[1] = u * u;
    entries[2] = 3.0 - 2.0 * u * v;
    entries[3] = -u * u - 2.0 * c;
}

static int brusselator_band(realtype t, N_Vector vector, N_Vector derivative, SUNMatrix matrix,
                            void *data, N_Vector a, N_Vector b, N_Vector c) {
    for (int i = 0; i < POINTS; i++) {
        double entries[4];
        brusselator_point(NV_DATA_S(vector), i, entries);
        for (int k = 0; k < 4; k++) SM_ELEMENT_B(matrix, 2 * i + k / 2, 2 * i + k % 2) = entries[k];
        for (int row = 2 * i; row < 2 * i + 2; row++) {
            if (i > 0) SM_ELEMENT_B(matrix, row, row - 2) = EXCHANGE;
            if (i < POINTS - 1) SM_ELEMENT_B(matrix, row, row + 2) = EXCHANGE;
        }
    }
    return 0;
}

/* Of either column of a point: left neighbour, both rows of the point, right neighbour. */
#define BRUSSELATOR_ENTRIES (2 * (4 * POINTS - 2))

static int brusselator_sparse(realtype t, N_Vector vector, N_Vector derivative, SUNMatrix matrix,
                              void *data, N_Vector a, N_Vector b, N_Vector c) {
    sunindextype *starts = SM_INDEXPTRS_S(matrix), *rows = SM_INDEXVALS_S(matrix), k = 0;
    double *values = SM_DATA_S(matrix);
    for (int column = 0; column < 2 * POINTS; column++) {
        double entries[4];
        int i = column / 2;
        brusselator_point(NV_DATA_S(vector), i, entries);
        starts[column] = k;
        if (i > 0) { rows[k] = column - 2; values[k++] = EXCHANGE; }
        rows[k] = 2 * i; values[k++] = entries[column % 2];
        rows[k] = 2 * i + 1; values[k++] = entries[2 + column % 2];
        if (i < POINTS - 1) { rows[k] = column + 2; values[k++] = EXCHANGE; }
    }
    starts[2 * POINTS] = k;
    return 0;
}

static const double AMPLIFIER_Y0[8] = {0.0, 3.0, 3.0, 6.0, 3.0, 3.0, 6.0, 0.0};
static const double AMPLIFIER_YP0[8] = {
    51.33927651718072, 51.33927651718072, -500.0 / 3.0, -24.97032851540633,
    -24.97032851540633, -250.0 / 3.0, -10.000276402456337, -10.000276402456337};
static const double CAPACITIES[8][8] = {
    {1e-6, -1e-6}, {-1e-6, 1e-6}, {[2] = 2e-6}, {[3] = 3e-6, -3e-6}, {[3] = -3e-6, 3e-6},
    {[5] = 4e-6}, {[6] = 5e-6, -5e-6}, {[6] = -5e-6, 5e-6}};

#define CONDUCTANCE (1.0 / 9000.0)
#define FIRST_CONDUCTANCE (1.0 / 1000.0)
#define SUPPLY 6.0
#define ALPHA 0.99
#define BETA 1e-6
#define THERMAL 0.026

/* M y' - f(t, y) */
static int amplifier(realtype t, N_Vector vector, N_Vector derivative, N_Vector result, void *data) {
    const double *y = NV_DATA_S(vector), *yp = NV_DATA_S(derivative);
    double *r = NV_DATA_S(result), signal = 0.1 * sin(200.0 * M_PI * t);
    r[0] = (signal - y[0]) * FIRST_CONDUCTANCE;
    for (int k = 1; k < 7; k += 3) {
        double current = BETA * expm1((y[k] - y[k + 1]) / THERMAL);
        r[k] = (SUPPLY - 2.0 * y[k]) * CONDUCTANCE - (1.0 - ALPHA) * current;
        r[k + 1] = current - y[k + 1] * CONDUCTANCE;
        r[k + 2] = (SUPPLY - y[k + 2]) * CONDUCTANCE - ALPHA * current;
    }
    r[7] = -y[7] * CONDUCTANCE;
    for (int i = 0; i < 8; i++) {
        r[i] = -r[i];
        for (int j = 0; j < 8; j++) r[i] += CAPACITIES[i][j] * yp[j];
    }
    return 0;
}

static int amplifier_dense(realtype t, realtype cj, N_Vector vector, N_Vector derivative,
                           N_Vector residual, SUNMatrix matrix, void *data, N_Vector a, N_Vector b,
                           N_Vector c) {
    const double *y = NV_DATA_S(vector);
    SM_ELEMENT_D(matrix, 0, 0) = -FIRST_CONDUCTANCE;
    SM_ELEMENT_D(matrix, 7, 7) = -CONDUCTANCE;
    for (int k = 1; k < 7; k += 3) {
        const double factors[] = {ALPHA - 1.0, 1.0, -ALPHA};
        double slope = BETA / THERMAL * exp((y[k] - y[k + 1]) / THERMAL);
        for (int i = k; i < k + 3; i++) {
            SM_ELEMENT_D(matrix, i, k) = factors[i - k] * slope;
            SM_ELEMENT_D(matrix, i, k + 1) = -factors[i - k] * slope;
            SM_ELEMENT_D(matrix, i, i) -= (i == k ? 2.0 : 1.0) * CONDUCTANCE;
        }
    }
    for (int j = 0; j < 8; j++) {
        for (int i = 0; i < 8; i++) {
            SM_ELEMENT_D(matrix, i, j) = cj * CAPACITIES[i][j] - SM_ELEMENT_D(matrix, i, j);
        }
    }
    return 0;
}
