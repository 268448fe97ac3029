/* The reference seal (scenarios/fms_reference.toml) written straight down in C on CVODE: what its integration costs when
 * nothing else is done.  For tests/benchmark/limit.py.
 *
 *     limit REPEATS TURNS RTOL...
 *
 * prints, for each tolerance: rtol, least wall time of the repeats (s), evaluations, and the largest error of the tilt at
 * 17 instants of the last tenth of the run, over clearance / outer radius, against a run at 1e-13.
 *
 * Film: Reynolds' equation in the radius alone, by moments: with c(r) = r h^3 and f(r) = int 12 mu (dh/dt) r dr,
 * p' = (f + k) / c; k follows from the pressures at the edges; force and moments from integrals of p by parts.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

/* Ten points serve this cone to 1e-8 of the film force; six, which leave 7e-5, are a fifth faster. */
#ifndef POINTS
#define POINTS 10
#endif
#define ANGLES 24
#define UNKNOWNS 6
#define INSTANTS 17

static const double r_i = 0.032, r_o = 0.040, clearance = 10e-6, coning = 3.125e-3, viscosity = 0.5e-3, pressure = 5e5;
static const double mass = 1.0, inertia = 8e-4, k_z = 5e5, d_z = 300.0, speed = 1000.0, runout = 25e-6, own = 25e-6;
static double k_t, d_t, closing, angle_cos[ANGLES], angle_sin[ANGLES], radius[POINTS], weight[POINTS];
static long evaluations;

static void film(double z, double gx, double gy, double z_rate, double gx_rate, double gy_rate, double *load)
{
    double force = 0.0, moment_x = 0.0, moment_y = 0.0, spin = 0.5 * speed;
    for (int n = 0; n < ANGLES; n++) {
        double c = angle_cos[n], s = angle_sin[n];
        double slope = gx * s - gy * c, around = gx * c + gy * s, slope_rate = gx_rate * s - gy_rate * c + spin * around;
        double a = 0.0, af = 0.0, b = 0.0, bf = 0.0, d = 0.0, df = 0.0;
        for (int k = 0; k < POINTS; k++) {
            double r = radius[k], h = clearance + z + slope * r + coning * (r - r_i), each = weight[k] / (r * h * h * h);
            double f = 12.0 * viscosity * (0.5 * z_rate * (r * r - r_i * r_i) + slope_rate * (r * r * r - r_i * r_i * r_i) / 3.0);
            a += each, af += each * f;
            each *= r * r, b += each, bf += each * f;
            each *= r, d += each, df += each * f;
        }
        double constant = (pressure - af) / a;
        double here = 0.5 * (pressure * r_o * r_o - bf - constant * b);
        double arm = (pressure * r_o * r_o * r_o - df - constant * d) / 3.0;
        force += here, moment_x += arm * s, moment_y -= arm * c;
    }
    load[0] = force * 2.0 * M_PI / ANGLES, load[1] = moment_x * 2.0 * M_PI / ANGLES, load[2] = moment_y * 2.0 * M_PI / ANGLES;
}

static int rates(sunrealtype t, N_Vector at, N_Vector out, void *nothing)
{
    double *y = N_VGetArrayPointer(at), *yp = N_VGetArrayPointer(out), load[3];
    double c = runout * cos(speed * t), s = runout * sin(speed * t);
    (void)nothing, evaluations++;
    film(y[0], y[1] - c, y[2] - s, y[3], y[4] + speed * s, y[5] - speed * c, load);
    yp[0] = y[3], yp[1] = y[4], yp[2] = y[5];
    yp[3] = (load[0] - closing - k_z * y[0] - d_z * y[3]) / mass;
    yp[4] = (load[1] - k_t * (y[1] - own) - d_t * y[4]) / inertia;
    yp[5] = (load[2] - k_t * y[2] - d_t * y[5]) / inertia;
    return 0;
}

static double integrate(double rtol, double end, double found[][2])
{
    static const double scale[UNKNOWNS] = {1e-5, 2.5e-4, 2.5e-4, 1e-2, 0.25, 0.25};
    SUNContext context;
    SUNContext_Create(0, &context);
    N_Vector y = N_VNew_Serial(UNKNOWNS, context), absolute = N_VNew_Serial(UNKNOWNS, context);
    N_VConst(0.0, y);
    for (int i = 0; i < UNKNOWNS; i++)
        N_VGetArrayPointer(absolute)[i] = rtol * scale[i];
    void *memory = CVodeCreate(CV_ADAMS, context);
    SUNMatrix matrix = SUNDenseMatrix(UNKNOWNS, UNKNOWNS, context);
    SUNLinearSolver solver = SUNLinSol_Dense(y, matrix, context);
    CVodeInit(memory, rates, 0.0, y);
    CVodeSVtolerances(memory, rtol, absolute);
    CVodeSetLinearSolver(memory, solver, matrix);
    CVodeSetMaxNumSteps(memory, 100000000);
    struct timespec begun, done;
    sunrealtype t;
    evaluations = 0;
    clock_gettime(CLOCK_MONOTONIC, &begun);
    for (int k = 0; k < INSTANTS; k++) {
        if (CVode(memory, end * (1.0 - 0.1 * (1.0 - k / (INSTANTS - 1.0))), y, &t, CV_NORMAL) < 0)
            exit(1);
        found[k][0] = N_VGetArrayPointer(y)[1], found[k][1] = N_VGetArrayPointer(y)[2];
    }
    clock_gettime(CLOCK_MONOTONIC, &done);
    CVodeFree(&memory), SUNLinSolFree(solver), SUNMatDestroy(matrix), N_VDestroy(y), N_VDestroy(absolute);
    SUNContext_Free(&context);
    return (done.tv_sec - begun.tv_sec) + 1e-9 * (done.tv_nsec - begun.tv_nsec);
}

int main(int count, char **words)
{
    /* Gauss points: roots of the Legendre polynomial by Newton's method. */
    for (int k = 0; k < POINTS; k++) {
        double x = cos(M_PI * (k + 0.75) / (POINTS + 0.5)), slope = 1.0;
        for (int round = 0; round < 20; round++) {
            double before = 0.0, p = 1.0;
            for (int j = 1; j <= POINTS; j++) {
                double next = ((2 * j - 1) * x * p - (j - 1) * before) / j;
                before = p, p = next;
            }
            slope = POINTS * (x * p - before) / (x * x - 1.0), x -= p / slope;
        }
        radius[k] = 0.5 * (r_i + r_o) + 0.5 * (r_o - r_i) * x;
        weight[k] = (r_o - r_i) / ((1.0 - x * x) * slope * slope);
    }
    for (int n = 0; n < ANGLES; n++)
        angle_cos[n] = cos(2.0 * M_PI * n / ANGLES), angle_sin[n] = sin(2.0 * M_PI * n / ANGLES);
    /* A ring of springs and dampers at 40 mm tilts with half their axial numbers. */
    k_t = 0.5 * k_z * 0.04 * 0.04, d_t = 0.5 * d_z * 0.04 * 0.04;
    double load[3], exact[INSTANTS][2], found[INSTANTS][2];
    film(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, load);
    closing = load[0];
    int repeats = atoi(words[1]);
    double end = atof(words[2]) * 2.0 * M_PI / speed;
    integrate(1e-13, end, exact);
    for (int i = 3; i < count; i++) {
        double least = 1e9, error = 0.0;
        for (int k = 0; k < repeats; k++)
            least = fmin(least, integrate(atof(words[i]), end, found));
        for (int k = 0; k < INSTANTS; k++)
            error = fmax(error, hypot(found[k][0] - exact[k][0], found[k][1] - exact[k][1]));
        printf("%s %.9f %ld %.3e %.12e %.12e\n", words[i], least, evaluations, error * r_o / clearance, found[16][0], found[16][1]);
    }
    return 0;
}
