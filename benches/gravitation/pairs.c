/* A straightforward implementation of the gravitation of N bodies in C: every pair once. Prints the time of one evaluation of all forces, s. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double *array(int n) { return calloc(n, sizeof(double)); }

int main(int argc, char **argv)
{
    int n = argc > 1 ? atoi(argv[1]) : 10000;
    double *x = array(n), *y = array(n), *z = array(n), *m = array(n);
    double *fx = array(n), *fy = array(n), *fz = array(n);
    double whole;
    for (int i = 0; i < n; i++) {
        x[i] = modf(i * 0.618033988, &whole);
        y[i] = modf(i * 0.414213562, &whole);
        z[i] = modf(i * 0.732050807, &whole);
        m[i] = 1 + modf(i * 0.236067977, &whole);
    }
    struct timespec start, end;
    clock_gettime(CLOCK_MONOTONIC, &start);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < i; j++) {
            double dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i];
            double square = dx * dx + dy * dy + dz * dz + 1e-4;
            double f = m[i] * m[j] / (square * sqrt(square));
            fx[i] += f * dx; fy[i] += f * dy; fz[i] += f * dz;
            fx[j] -= f * dx; fy[j] -= f * dy; fz[j] -= f * dz;
        }
    }
    clock_gettime(CLOCK_MONOTONIC, &end);
    double seconds = (end.tv_sec - start.tv_sec) + 1e-9 * (end.tv_nsec - start.tv_nsec);
    printf("%.9f %.17g\n", seconds, fx[n / 2]);
    return 0;
}
