/* A unit of FMI 2.0 for model exchange, with a closed form: a room with a thermostat, its fast sensor, and a ball that bounces.
 *
 * Events: of state (the thermostat, the ball), in time (set-points rise at an hour), after a completed step (the first one after
 * 100 s), and the input. With PREFIX all functions have the name of the model before their own. */
#include <signal.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#ifdef PREFIX
#define F(name) unit_fmi2##name
#else
#define F(name) fmi2##name
#endif

enum { ROOM, SENSOR, HEIGHT, SPEED, STATES, ON = STATES, SEEN, POWER };
static const double GAIN = 0.1, CAPACITY = 1000.0, OUTDOOR = 5.0, LAG = 0.01, GRAVITY = 9.81;

typedef struct {
    double time, x[STATES], power, low, high;
    int on, seen, wants_seen, raised, rests;
} Unit;

typedef struct {
    int again, ends, nominals, states, has_next;
    double next;
} EventInfo;

void *F(Instantiate)(const char *name, int kind, const char *guid, const char *resources, const void *callbacks, int visible,
                     int logs) {
    (void)name, (void)resources, (void)callbacks, (void)visible, (void)logs;
    return kind == 0 && strcmp(guid, "{room}") == 0 ? calloc(1, sizeof(Unit)) : NULL;
}
void F(FreeInstance)(void *c) { free(c); }
const char *F(GetVersion)(void) { return "2.0"; }
const char *F(GetTypesPlatform)(void) { return "default"; }
int F(Reset)(void *c) {
    memset(c, 0, sizeof(Unit));
    return 0;
}
int F(SetDebugLogging)(void *c, int on, size_t n, const char *const *names) {
    (void)c, (void)on, (void)n, (void)names;
    return 0;
}
int F(SetupExperiment)(void *c, int has_tolerance, double tolerance, double start, int has_end, double end) {
    (void)has_tolerance, (void)tolerance, (void)has_end, (void)end;
    *(Unit *)c = (Unit){.time = start, .x = {18.0, 18.0, 1.0, 0.0}, .power = 2.0, .low = 19.0, .high = 20.0, .on = 1};
    return 0;
}
int F(EnterInitializationMode)(void *c) { return (void)c, 0; }
int F(ExitInitializationMode)(void *c) { return (void)c, 0; }
int F(EnterEventMode)(void *c) { return (void)c, 0; }
int F(EnterContinuousTimeMode)(void *c) { return (void)c, 0; }
int F(Terminate)(void *c) { return (void)c, 0; }

int F(NewDiscreteStates)(void *c, EventInfo *info) {
    Unit *u = c;
    *info = (EventInfo){0};
    if (!u->raised && u->time >= 3600.0) {
        u->raised = 1, u->low += 2.0, u->high += 2.0;
    }
    if (u->on && u->x[ROOM] >= u->high) u->on = 0;
    else if (!u->on && u->x[ROOM] <= u->low) u->on = 1;
    if (u->x[HEIGHT] <= 0.0 && u->x[SPEED] < 0.0) {
        u->x[HEIGHT] = 0.0, u->x[SPEED] *= -0.7, info->states = 1;
        if (u->x[SPEED] < 0.1) u->x[SPEED] = 0.0, u->rests = 1;
    }
    u->seen |= u->wants_seen;
    info->has_next = !u->raised, info->next = 3600.0;
    return 0;
}
int F(SetTime)(void *c, double time) {
    ((Unit *)c)->time = time;
    return 0;
}
int F(SetContinuousStates)(void *c, const double *x, size_t n) {
    if (n != STATES) return 3;
    memcpy(((Unit *)c)->x, x, n * sizeof(double));
    return 0;
}
int F(GetContinuousStates)(void *c, double *x, size_t n) {
    memcpy(x, ((Unit *)c)->x, n * sizeof(double));
    return 0;
}
int F(GetNominalsOfContinuousStates)(void *c, double *x, size_t n) {
    (void)c;
    for (size_t i = 0; i < n; i++) x[i] = 1.0;
    return 0;
}
int F(GetDerivatives)(void *c, double *rates, size_t n) {
    Unit *u = c;
    if (n != STATES) return 3;
    if (u->power == -1.0) raise(SIGSEGV);
    while (u->power == -2.0) {
    }
    rates[ROOM] = (u->power * u->on - GAIN * (u->x[ROOM] - OUTDOOR)) / CAPACITY;
    rates[SENSOR] = (u->x[ROOM] - u->x[SENSOR]) / LAG;
    rates[HEIGHT] = u->x[SPEED];
    rates[SPEED] = u->rests ? 0.0 : -GRAVITY;
    return 0;
}
int F(GetEventIndicators)(void *c, double *z, size_t n) {
    Unit *u = c;
    if (n != 2) return 3;
    z[0] = u->on ? u->x[ROOM] - u->high : u->low - u->x[ROOM];
    z[1] = u->rests ? 1.0 : u->x[HEIGHT];
    return 0;
}
int F(CompletedIntegratorStep)(void *c, int no_return, int *event, int *ends) {
    Unit *u = c;
    (void)no_return;
    *ends = 0;
    *event = u->wants_seen = !u->seen && u->time >= 100.0;
    return 0;
}
int F(GetReal)(void *c, const unsigned *references, size_t n, double *values) {
    Unit *u = c;
    for (size_t i = 0; i < n; i++) {
        unsigned r = references[i];
        values[i] = r < STATES ? u->x[r] : r == ON ? u->on : r == SEEN ? u->seen : u->power;
    }
    return 0;
}
int F(SetReal)(void *c, const unsigned *references, size_t n, const double *values) {
    for (size_t i = 0; i < n; i++) {
        if (references[i] != POWER) return 3;
        ((Unit *)c)->power = values[i];
    }
    return 0;
}

/* Functions that a library must have, and this unit does not offer. */
#define MISSING(name) \
    int F(name)(void) { return 3; }
MISSING(GetInteger)
MISSING(GetBoolean)
MISSING(GetString)
MISSING(SetInteger)
MISSING(SetBoolean)
MISSING(SetString)
MISSING(GetFMUstate)
MISSING(SetFMUstate)
MISSING(FreeFMUstate)
MISSING(SerializedFMUstateSize)
MISSING(SerializeFMUstate)
MISSING(DeSerializeFMUstate)
MISSING(GetDirectionalDerivative)
