/* Explicit central differences (leapfrog) with lumped masses, the way of explicit structural codes:
 * linear triangles, plane strain, St. Venant-Kirchhoff or small strain, viscosity at the velocity of the
 * half step before, penalty floor. One loop over the cells per step.
 *
 * Arguments as src/external.rs says; the setting is the step as a fraction of the limit of
 * stability, which is found by power iteration at rest. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct {
    int nodes[3];
    double g[3][2]; /* gradients of the shape functions */
    double w;       /* volume */
} cell_t;

static int n_nodes, n_cells, n_phases, n_times, n_held, is_green, has_viscosity;
static double lambda, mu, lambda_vis, mu_vis, thickness, gravity[2], alpha;
static double *position, *mass, *times, *phase_end, *phase_floor;
static cell_t *cells;
static int n_boundary, *boundary, *held_phase, *held_dof;
static double *held_velocity;

static void *get(size_t count, size_t size) {
    void *memory = calloc(count ? count : 1, size);
    if (!memory) { puts("failed: no memory"); exit(1); }
    return memory;
}

/* Reads a table of `columns` numbers a line. */
static double *read_table(const char *folder, const char *name, int columns, int *rows) {
    char path[4096];
    snprintf(path, sizeof path, "%s%s%s", folder ? folder : "", folder ? "/" : "", name);
    FILE *file = fopen(path, "r");
    if (!file) { printf("failed: %s cannot be read\n", path); exit(1); }
    size_t count = 0, room = 1024;
    double *table = get(room, sizeof *table), x;
    while (fscanf(file, "%lf", &x) == 1) {
        if (count == room) {
            table = realloc(table, (room *= 2) * sizeof *table);
            if (!table) { puts("failed: no memory"); exit(1); }
        }
        table[count++] = x;
    }
    fclose(file);
    *rows = (int)(count / columns);
    return table;
}

static void read_case(const char *folder, const char *times_file) {
    int rows;
    double *table;
    position = read_table(folder, "nodes", 2, &n_nodes);
    table = read_table(folder, "numbers", 11, &rows);
    lambda = table[0], mu = table[1], lambda_vis = table[2], mu_vis = table[3];
    thickness = table[4], gravity[0] = table[5], gravity[1] = table[6];
    is_green = table[7] != 0.0, alpha = table[8];
    has_viscosity = mu_vis > 0.0;
    free(table);
    table = read_table(folder, "cells", 3, &n_cells);
    cells = get(n_cells, sizeof *cells);
    for (int c = 0; c < n_cells; c++) {
        cell_t *cell = &cells[c];
        const double *x[3];
        for (int a = 0; a < 3; a++) {
            cell->nodes[a] = (int)table[3 * c + a] - 1;
            x[a] = &position[2 * cell->nodes[a]];
        }
        double twice = (x[1][0] - x[0][0]) * (x[2][1] - x[0][1])
                     - (x[2][0] - x[0][0]) * (x[1][1] - x[0][1]);
        for (int a = 0; a < 3; a++) {
            const double *p = x[(a + 1) % 3], *q = x[(a + 2) % 3];
            cell->g[a][0] = (p[1] - q[1]) / twice;
            cell->g[a][1] = (q[0] - p[0]) / twice;
        }
        cell->w = 0.5 * twice * thickness;
    }
    free(table);
    table = read_table(folder, "masses", 3, &rows);
    mass = get(n_nodes, sizeof *mass);
    for (int k = 0; k < rows; k++) mass[(int)table[3 * k] - 1] += table[3 * k + 2];
    free(table);
    table = read_table(folder, "boundary", 1, &n_boundary);
    boundary = get(n_boundary, sizeof *boundary);
    for (int k = 0; k < n_boundary; k++) boundary[k] = (int)table[k] - 1;
    free(table);
    table = read_table(folder, "phases", 2, &n_phases);
    phase_end = get(n_phases, sizeof *phase_end), phase_floor = get(n_phases, sizeof *phase_floor);
    for (int k = 0; k < n_phases; k++) phase_end[k] = table[2 * k], phase_floor[k] = table[2 * k + 1];
    free(table);
    table = read_table(folder, "held", 3, &n_held);
    held_phase = get(n_held, sizeof *held_phase), held_dof = get(n_held, sizeof *held_dof);
    held_velocity = get(n_held, sizeof *held_velocity);
    for (int k = 0; k < n_held; k++) {
        held_phase[k] = (int)table[3 * k] - 1, held_dof[k] = (int)table[3 * k + 1] - 1;
        held_velocity[k] = table[3 * k + 2];
    }
    free(table);
    times = read_table(NULL, times_file, 1, &n_times);
}

/* f -= internal forces at the displacements u and velocities v. */
static void add_green(const double *restrict u, const double *restrict v, double *restrict f) {
    for (int c = 0; c < n_cells; c++) {
        const cell_t *cell = &cells[c];
        double h[2][2] = {{0}}, hv[2][2] = {{0}};
        for (int a = 0; a < 3; a++) {
            const double *ua = &u[2 * cell->nodes[a]], *g = cell->g[a];
            h[0][0] += ua[0] * g[0], h[0][1] += ua[0] * g[1];
            h[1][0] += ua[1] * g[0], h[1][1] += ua[1] * g[1];
        }
        double exx = h[0][0] + 0.5 * (h[0][0] * h[0][0] + h[1][0] * h[1][0]);
        double eyy = h[1][1] + 0.5 * (h[0][1] * h[0][1] + h[1][1] * h[1][1]);
        double exy = 0.5 * (h[0][1] + h[1][0] + h[0][0] * h[0][1] + h[1][0] * h[1][1]);
        double trace = lambda * (exx + eyy);
        double sxx = trace + 2 * mu * exx, syy = trace + 2 * mu * eyy, sxy = 2 * mu * exy;
        double fxx = 1 + h[0][0], fxy = h[0][1], fyx = h[1][0], fyy = 1 + h[1][1];
        if (has_viscosity) {
            for (int a = 0; a < 3; a++) {
                const double *va = &v[2 * cell->nodes[a]], *g = cell->g[a];
                hv[0][0] += va[0] * g[0], hv[0][1] += va[0] * g[1];
                hv[1][0] += va[1] * g[0], hv[1][1] += va[1] * g[1];
            }
            double rxx = fxx * hv[0][0] + fyx * hv[1][0];
            double ryy = fxy * hv[0][1] + fyy * hv[1][1];
            double rxy = 0.5 * (fxx * hv[0][1] + fyx * hv[1][1] + fxy * hv[0][0] + fyy * hv[1][0]);
            double rate = lambda_vis * (rxx + ryy);
            sxx += rate + 2 * mu_vis * rxx, syy += rate + 2 * mu_vis * ryy, sxy += 2 * mu_vis * rxy;
        }
        double w = cell->w;
        double pxx = w * (fxx * sxx + fxy * sxy), pxy = w * (fxx * sxy + fxy * syy);
        double pyx = w * (fyx * sxx + fyy * sxy), pyy = w * (fyx * sxy + fyy * syy);
        for (int a = 0; a < 3; a++) {
            double *fa = &f[2 * cell->nodes[a]];
            const double *g = cell->g[a];
            fa[0] -= pxx * g[0] + pxy * g[1];
            fa[1] -= pyx * g[0] + pyy * g[1];
        }
    }
}

/* The same for small strain, with viscosity of the shape at rest. */
static void add_small(const double *restrict u, const double *restrict v, double *restrict f) {
    for (int c = 0; c < n_cells; c++) {
        const cell_t *cell = &cells[c];
        double exx = 0, eyy = 0, exy = 0, rxx = 0, ryy = 0, rxy = 0;
        for (int a = 0; a < 3; a++) {
            const double *ua = &u[2 * cell->nodes[a]], *va = &v[2 * cell->nodes[a]], *g = cell->g[a];
            exx += ua[0] * g[0], eyy += ua[1] * g[1], exy += 0.5 * (ua[0] * g[1] + ua[1] * g[0]);
            rxx += va[0] * g[0], ryy += va[1] * g[1], rxy += 0.5 * (va[0] * g[1] + va[1] * g[0]);
        }
        double trace = lambda * (exx + eyy) + lambda_vis * (rxx + ryy), w = cell->w;
        double sxx = w * (trace + 2 * (mu * exx + mu_vis * rxx));
        double syy = w * (trace + 2 * (mu * eyy + mu_vis * ryy));
        double sxy = w * 2 * (mu * exy + mu_vis * rxy);
        for (int a = 0; a < 3; a++) {
            double *fa = &f[2 * cell->nodes[a]];
            const double *g = cell->g[a];
            fa[0] -= sxx * g[0] + sxy * g[1];
            fa[1] -= sxy * g[0] + syy * g[1];
        }
    }
}

static void add_internal(const double *u, const double *v, double *f) {
    if (is_green) add_green(u, v, f);
    else add_small(u, v, f);
}

/* All forces. */
static void forces(const double *u, const double *v, double floor_stiffness, double *f) {
    for (int i = 0; i < n_nodes; i++) {
        f[2 * i] = mass[i] * gravity[0], f[2 * i + 1] = mass[i] * gravity[1];
    }
    add_internal(u, v, f);
    if (floor_stiffness > 0.0) {
        for (int k = 0; k < n_boundary; k++) {
            int i = boundary[k];
            double height = position[2 * i + 1] + u[2 * i + 1];
            if (height < 0.0) f[2 * i + 1] -= floor_stiffness * height;
        }
    }
}

/* Longest stable step at rest: 2 / (r + sqrt(r^2 + omega^2)) for lagged viscosity, with the highest
 * frequency omega and half the highest rate of decay r, by power iteration. */
static double longest_step(const int *is_held) {
    int n = 2 * n_nodes;
    double omega2 = 0.0, rate = 0.0, *x = get(n, 8), *zero = get(n, 8), *f = get(n, 8);
    for (int pass = 0; pass <= has_viscosity; pass++) {
        srand(1);
        for (int i = 0; i < n; i++) x[i] = is_held[i] ? 0.0 : rand() / (double)RAND_MAX - 0.5;
        double growth = 0.0;
        for (int k = 0; k < 200; k++) {
            double norm = 0.0;
            for (int i = 0; i < n; i++) norm += x[i] * x[i];
            norm = sqrt(norm);
            for (int i = 0; i < n; i++) x[i] *= 1e-7 / norm, f[i] = 0.0;
            if (pass == 0) add_internal(x, zero, f);
            else add_internal(zero, x, f);
            growth = 0.0;
            for (int i = 0; i < n; i++) {
                x[i] = is_held[i] ? 0.0 : -f[i] / mass[i / 2];
                growth += x[i] * x[i];
            }
            growth = sqrt(growth) / 1e-7;
        }
        if (pass == 0) omega2 = growth;
        else rate = growth;
    }
    free(x), free(zero), free(f);
    double r = 0.5 * rate;
    return 2.0 / (r + sqrt(r * r + omega2));
}

static long steps, evaluations;

/* Returns 0 if the motion stays finite. */
static int run(double fraction, double *out) {
    int n = 2 * n_nodes, taken = 0;
    double t = 0.0, *u = get(n, 8), *v = get(n, 8), *f = get(n, 8);
    double *slope = get(n, 8), *base = get(n, 8), *path = get(n, 8);
    int *is_held = get(n, sizeof *is_held), *list = get(n, sizeof *list);
    steps = evaluations = 0;
    for (int p = 0; p < n_phases; p++) {
        int n_list = 0;
        memset(is_held, 0, n * sizeof *is_held);
        for (int k = 0; k < n_held; k++) {
            if (held_phase[k] != p) continue;
            int i = held_dof[k];
            is_held[i] = 1, list[n_list++] = i;
            path[i] = held_velocity[k], base[i] = u[i];
            slope[i] = v[i] - path[i];
        }
        double start = t, length = phase_end[p] - start, longest = fraction * longest_step(is_held);
        long count = (long)ceil(length / longest);
        double h = length / count;
        for (long k = 0; k < count; k++, steps++, evaluations++) {
            /* v is that of the half step before, but for the first step */
            forces(u, v, phase_floor[p], f);
            double kick = k ? h : 0.5 * h, t0 = start + k * h, t1 = start + (k + 1) * h;
            while (taken < n_times && times[taken] < t1) {
                double s = times[taken] - t0, *sample = &out[(size_t)n * taken++];
                for (int i = 0; i < n; i++) {
                    double a = f[i] / mass[i / 2], now = k ? v[i] + 0.5 * h * a : v[i];
                    sample[i] = u[i] + (is_held[i] ? path[i] * s : s * now + 0.5 * s * s * a);
                }
            }
            for (int i = 0; i < n_nodes; i++) {
                double by_mass = kick / mass[i];
                v[2 * i] += by_mass * f[2 * i], v[2 * i + 1] += by_mass * f[2 * i + 1];
                u[2 * i] += h * v[2 * i], u[2 * i + 1] += h * v[2 * i + 1];
            }
            /* held nodes go to their paths at the rate alpha: see src/stage.rs */
            for (int j = 0; j < n_list; j++) {
                int i = list[j];
                double s = t1 - start, half = s - 0.5 * h;
                u[i] = base[i] + path[i] * s + slope[i] * s * exp(-alpha * s);
                v[i] = path[i] + slope[i] * (1 - alpha * half) * exp(-alpha * half);
            }
        }
        /* from the half step to the end */
        forces(u, v, phase_floor[p], f), evaluations++;
        for (int i = 0; i < n; i++) v[i] += is_held[i] ? 0.0 : 0.5 * h * f[i] / mass[i / 2];
        for (int j = 0; j < n_list; j++) v[list[j]] = path[list[j]];
        t = phase_end[p];
        while (taken < n_times && times[taken] <= t) {
            memcpy(&out[(size_t)n * taken++], u, n * sizeof *u);
        }
    }
    int is_finite = 1;
    for (int i = 0; i < n; i++) is_finite &= isfinite(u[i]) && fabs(u[i]) < 1e3;
    free(u), free(v), free(f), free(slope), free(base), free(path);
    free(is_held), free(list);
    return !is_finite;
}

int main(int count, char **arguments) {
    if (count != 8) { puts("failed: arguments as src/external.rs says"); return 1; }
    read_case(arguments[5], arguments[6]);
    double *out = get((size_t)n_times * 2 * n_nodes, sizeof *out), least = INFINITY, sum = 0.0;
    int runs = 0;
    while (runs < 5 && sum < 0.6) { /* as src/motion.rs says */
        clock_t start = clock();
        int trouble = run(atof(arguments[4]), out);
        double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
        least = fmin(least, seconds), sum += seconds, runs++;
        if (trouble) { puts("failed: the motion runs away"); return 0; }
    }
    FILE *file = fopen(arguments[7], "wb");
    if (!file || fwrite(out, 8, (size_t)n_times * 2 * n_nodes, file) != (size_t)n_times * 2 * n_nodes
        || fclose(file)) {
        puts("failed: the displacements cannot be written");
        return 1;
    }
    printf("%.9f %ld %ld 0\n", least, steps, evaluations);
    return 0;
}
