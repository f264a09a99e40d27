/* The paper's method in plain C. It shares no code with bankshot, so that the two can be compared.
 *
 * RK4 with a step of dt_max in flight. The step is halved on the way into a contact, down to dt_min. Spin and
 * slip are vectors in space. There is no contact frame.
 *
 * Reads lines of "distance_ft court_angle_deg height_ft speed_ft_s pitch_deg polar_deg backspin_rev_s" from
 * stdin. Writes 1 (made) or 0 (missed) for each line to stdout, and the shots per second to stderr.
 *
 *   cc -O3 -march=native -ffast-math -o paper_rk4 paper_rk4.c -lm
 *   ./paper_rk4 DT_MAX DT_MIN [DAMPING] < shots.txt        (0.015 0.0005 are the paper's steps, s)
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* Units of the paper: ft, s, lb (weight), slug. */
static const double PI = 3.14159265358979323846, G = 32.2, MASS = 21.0 / 16.0 / 32.2, K = 2000.0, MU = 1.0;
static const double RING = (9.0 + 5.0 / 16.0) / 12.0, FACE = -1.25, HALF_WIDTH = 3.0, BOTTOM = -0.5, TOP = 3.0;
static const double HOOP = 10.0, TIME_LIMIT = 10.0;
/* The damping C, lb s/ft, can be replaced by the third argument. */
static double RADIUS, C = 1.53;

typedef struct {
    double x[9]; /* position, velocity, angular velocity */
} State;

/* Adds the force of one contact to the rates. n points from the solid to the centre, u is the compression. */
static void contact(const State *s, const double n[3], double u, double rate[9]) {
    const double *v = s->x + 3, *w = s->x + 6, lever = RADIUS - u;
    double vn = v[0] * n[0] + v[1] * n[1] + v[2] * n[2], force = (K * u - C * vn) / MASS, arm[3], slip[3], size = 0;
    for (int i = 0; i < 3; i++) arm[i] = -lever * n[i];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        slip[i] = v[i] - vn * n[i] + w[j] * arm[k] - w[k] * arm[j];
        size += slip[i] * slip[i];
    }
    size = sqrt(size);
    double pull = size > 0 && force > 0 ? -MU * force / size : 0, friction[3];
    for (int i = 0; i < 3; i++) {
        friction[i] = pull * slip[i];
        rate[3 + i] += force * n[i] + friction[i];
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        rate[6 + i] += (arm[j] * friction[k] - arm[k] * friction[j]) / (2.0 / 3.0 * RADIUS * RADIUS);
    }
}

/* The solids that are compressed: bit 0 the board, bit 1 the ring. */
static int pressed(const State *s) {
    const double *p = s->x;
    int board = p[0] < FACE + RADIUS && p[0] > FACE && fabs(p[1]) < HALF_WIDTH && p[2] > BOTTOM && p[2] < TOP;
    double in = RING - sqrt(p[0] * p[0] + p[1] * p[1]);
    return board | (in * in + p[2] * p[2] < RADIUS * RADIUS) << 1;
}

/* The rates of the state; returns the solids that are compressed. */
static int derive(const State *s, double rate[9]) {
    const double *p = s->x;
    for (int i = 0; i < 3; i++) {
        rate[i] = s->x[3 + i];
        rate[3 + i] = rate[6 + i] = 0;
    }
    rate[5] = -G;
    int touch = pressed(s);
    if (touch & 1) {
        const double n[3] = {1, 0, 0};
        contact(s, n, FACE + RADIUS - p[0], rate);
    }
    if (touch & 2) {
        double axis = sqrt(p[0] * p[0] + p[1] * p[1]), in = RING - axis, lever = sqrt(in * in + p[2] * p[2]);
        const double n[3] = {-in * p[0] / axis / lever, -in * p[1] / axis / lever, p[2] / lever};
        contact(s, n, RADIUS - lever, rate);
    }
    return touch;
}

static State moved(const State *s, const double rate[9], double dt) {
    State t;
    for (int i = 0; i < 9; i++) t.x[i] = s->x[i] + dt * rate[i];
    return t;
}

/* Whether a shot is made. */
static int made(State s, double dt_max, double dt_min) {
    double dt = dt_max, time = 0;
    int touch = pressed(&s), above = s.x[2] >= 0, rose = 0;
    for (;;) {
        double k1[9], k2[9], k3[9], k4[9];
        int touched = derive(&s, k1);
        State t = moved(&s, k1, dt / 2);
        touched |= derive(&t, k2);
        t = moved(&s, k2, dt / 2);
        touched |= derive(&t, k3);
        t = moved(&s, k3, dt);
        touched |= derive(&t, k4);
        State next;
        for (int i = 0; i < 9; i++) next.x[i] = s.x[i] + dt / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
        int now = pressed(&next);
        if ((touched || now) && !touch && dt > dt_min) {
            dt = fmax(dt / 2, dt_min);
            continue;
        }
        if (s.x[2] < 0 && next.x[2] >= 0) {
            above = 1;
            rose |= next.x[0] * next.x[0] + next.x[1] * next.x[1] < RING * RING;
        }
        if (s.x[2] >= -RADIUS && next.x[2] < -RADIUS) { /* The point where the step crosses the plane. */
            double vz = s.x[5], fall = (vz + sqrt(vz * vz + 2 * G * (s.x[2] + RADIUS))) / G;
            double x = s.x[0] + fall * s.x[3], y = s.x[1] + fall * s.x[4];
            return above && !rose && x * x + y * y < RING * RING;
        }
        s = next;
        touch = now;
        time += dt;
        if (s.x[0] < FACE || time > TIME_LIMIT || (s.x[2] < -RADIUS && s.x[5] < 0)) return 0;
        dt = touch ? dt_min : fmin(2 * dt, dt_max);
    }
}

int main(int count, char **arguments) {
    double dt_max = count > 1 ? atof(arguments[1]) : 0.015, dt_min = count > 2 ? atof(arguments[2]) : 0.0005;
    if (count > 3) C = atof(arguments[3]);
    RADIUS = 29.75 / (24 * PI);
    size_t shots = 0, capacity = 1024;
    State *starts = malloc(capacity * sizeof *starts);
    double d, court, height, speed, pitch, polar, spin, deg = PI / 180;
    while (scanf("%lf %lf %lf %lf %lf %lf %lf", &d, &court, &height, &speed, &pitch, &polar, &spin) == 7) {
        if (shots == capacity) starts = realloc(starts, (capacity *= 2) * sizeof *starts);
        double level = speed * cos(pitch * deg), sp = sin(polar * deg), cp = cos(polar * deg), w = 2 * PI * spin;
        State s = {{d * cos(court * deg), d * sin(court * deg), height - HOOP, -level * cp, -level * sp,
                    speed * sin(pitch * deg), -w * sp, w * cp, 0}};
        starts[shots++] = s;
    }
    char *verdicts = malloc(shots + 1);
    clock_t began = clock();
    for (size_t i = 0; i < shots; i++) verdicts[i] = (char)('0' + made(starts[i], dt_max, dt_min));
    fprintf(stderr, "%.0f\n", shots * (double)CLOCKS_PER_SEC / (double)(clock() - began));
    verdicts[shots] = 0;
    puts(verdicts);
    return 0;
}
