/* A linear model whose matrices, inputs and switches are arrays of FMI 3.0: x' = A x + B (u where on), y = gain x. Each
 * setter wants whole arrays, as the standard says, and so refuses any other count of values. A step with an input of
 * 100 or more is discarded. */
#include <stdlib.h>
#include <string.h>

#include "fmi3.h"

enum { N = 2, M = 3, PARTS = 1000 };

typedef struct {
  double time, length, u[M], A[N * N], B[N * M], x[N];
  int32_t gain[N];
  bool on[M];
} model;

static const model START = {.u = {1.0, 2.0, 3.0},
                            .A = {0.0, 1.0, -4.0, -0.4},
                            .B = {0.0, 0.0, 0.0, 1.0, 0.5, 0.25},
                            .gain = {1, 1},
                            .on = {true, true, true}};

static void rates(const model *s, const double *x, double *xd) {
  for (int i = 0; i < N; i++) {
    xd[i] = 0.0;
    for (int j = 0; j < N; j++) xd[i] += s->A[N * i + j] * x[j];
    for (int j = 0; j < M; j++) xd[i] += s->on[j] ? s->B[M * i + j] * s->u[j] : 0.0;
  }
}

FMI3_EXPORT const char *FMI3_NAME(fmi3GetVersion)(void) { return "3.0"; }

FMI3_EXPORT fmi3Instance FMI3_NAME(fmi3InstantiateCoSimulation)(void) {
  model *s = malloc(sizeof *s);
  if (s != NULL) *s = START;
  return s;
}

FMI3_EXPORT void FMI3_NAME(fmi3FreeInstance)(fmi3Instance s) { free(s); }

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3EnterInitializationMode)(fmi3Instance s, fmi3Boolean defined,
                                                              fmi3Float64 tolerance, fmi3Float64 start) {
  (void)defined, (void)tolerance;
  ((model *)s)->time = start;
  return fmi3OK;
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3ExitInitializationMode)(fmi3Instance s) { return s ? fmi3OK : fmi3Error; }
FMI3_EXPORT fmi3Status FMI3_NAME(fmi3Terminate)(fmi3Instance s) { return s ? fmi3OK : fmi3Error; }

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3Reset)(fmi3Instance s) {
  *(model *)s = START;
  return fmi3OK;
}

static size_t floats(model *s, fmi3ValueReference r, double **at) {
  double *const places[] = {&s->time, s->u, s->A, s->B, NULL, NULL, NULL, s->x};
  static const size_t counts[] = {1, M, N * N, N * M, 0, 0, 0, N};
  if (r > 7 || counts[r] == 0) return 0;
  *at = places[r];
  return counts[r];
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetFloat64)(fmi3Instance instance, const fmi3ValueReference *r, size_t n,
                                                 fmi3Float64 *values, size_t count) {
  model *s = instance;
  double *at = NULL;
  for (size_t k = 0; k < n; k++) {
    const size_t size = floats(s, r[k], &at);
    if (size == 0 || size > count) return fmi3Error;
    for (size_t i = 0; i < size; i++) *values++ = r[k] == 7 ? s->gain[i] * at[i] : at[i];
    count -= size;
  }
  return count == 0 ? fmi3OK : fmi3Error;
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetFloat64)(fmi3Instance s, const fmi3ValueReference *r, size_t n,
                                                 const fmi3Float64 *values, size_t count) {
  double *at = NULL;
  for (size_t k = 0; k < n; k++) {
    const size_t size = r[k] == 7 ? 0 : floats(s, r[k], &at);
    if (size == 0 || size > count) return fmi3Error;
    memcpy(at, values, size * sizeof *values);
    values += size, count -= size;
  }
  return count == 0 ? fmi3OK : fmi3Error;
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetInt32)(fmi3Instance s, const fmi3ValueReference *r, size_t n,
                                               const fmi3Int32 *values, size_t count) {
  if (n != 1 || r[0] != 4 || count != N) return fmi3Error;
  memcpy(((model *)s)->gain, values, sizeof((model *)s)->gain);
  return fmi3OK;
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetBoolean)(fmi3Instance s, const fmi3ValueReference *r, size_t n,
                                                 const fmi3Boolean *values, size_t count) {
  if (n != 1 || r[0] != 5 || count != M) return fmi3Error;
  memcpy(((model *)s)->on, values, sizeof((model *)s)->on);
  return fmi3OK;
}

static void advance(model *s, double length) {
  const double h = length / PARTS;
  for (int k = 0; k < PARTS; k++) { /* the midpoint rule */
    double xd[N], mid[N];
    rates(s, s->x, xd);
    for (int i = 0; i < N; i++) mid[i] = s->x[i] + 0.5 * h * xd[i];
    rates(s, mid, xd);
    for (int i = 0; i < N; i++) s->x[i] += h * xd[i];
  }
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3DoStep)(fmi3Instance instance, fmi3Float64 time, fmi3Float64 length,
                                             fmi3Boolean no_return, fmi3Boolean *event, fmi3Boolean *ends,
                                             fmi3Boolean *early, fmi3Float64 *last) {
  model *s = instance;
  (void)no_return;
  *last = time;
  *event = *ends = *early = false;
  for (int j = 0; j < M; j++)
    if (s->u[j] >= 100.0) return fmi3Discard;
  advance(s, length);
  s->length = length;
  s->time = *last = time + length;
  return fmi3OK;
}

/* Of y by u over the last step: as the model is linear, what that step makes of rest under the seed. */
FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetDirectionalDerivative)(fmi3Instance instance, const fmi3ValueReference *of,
                                                               size_t count, const fmi3ValueReference *by, size_t known,
                                                               const fmi3Float64 *seed, size_t seeds,
                                                               fmi3Float64 *found, size_t size) {
  if (count != 1 || of[0] != 7 || known != 1 || by[0] != 1 || seeds != M || size != N) return fmi3Error;
  model s = *(const model *)instance;
  memset(s.x, 0, sizeof s.x);
  memcpy(s.u, seed, sizeof s.u);
  advance(&s, s.length);
  for (int i = 0; i < N; i++) found[i] = s.gain[i] * s.x[i];
  return fmi3OK;
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3GetFMUState)(fmi3Instance s, fmi3FMUState *state) {
  if (*state == NULL) *state = malloc(sizeof(model));
  if (*state == NULL) return fmi3Error;
  memcpy(*state, s, sizeof(model));
  return fmi3OK;
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3SetFMUState)(fmi3Instance s, fmi3FMUState state) {
  memcpy(s, state, sizeof(model));
  return fmi3OK;
}

FMI3_EXPORT fmi3Status FMI3_NAME(fmi3FreeFMUState)(fmi3Instance s, fmi3FMUState *state) {
  (void)s;
  free(*state);
  *state = NULL;
  return fmi3OK;
}

/* FMPy wants every function of the standard to be there. */
#define NONE(name)                                                                                                     \
  FMI3_EXPORT fmi3Status FMI3_NAME(name)(void) { return fmi3Error; }
NONE(fmi3ActivateModelPartition)
NONE(fmi3CompletedIntegratorStep)
NONE(fmi3DeserializeFMUState)
NONE(fmi3EnterConfigurationMode)
NONE(fmi3EnterContinuousTimeMode)
NONE(fmi3EnterEventMode)
NONE(fmi3EnterStepMode)
NONE(fmi3EvaluateDiscreteStates)
NONE(fmi3ExitConfigurationMode)
NONE(fmi3GetAdjointDerivative)
NONE(fmi3GetBinary)
NONE(fmi3GetBoolean)
NONE(fmi3GetClock)
NONE(fmi3GetContinuousStateDerivatives)
NONE(fmi3GetContinuousStates)
NONE(fmi3GetEventIndicators)
NONE(fmi3GetFloat32)
NONE(fmi3GetInt16)
NONE(fmi3GetInt32)
NONE(fmi3GetInt64)
NONE(fmi3GetInt8)
NONE(fmi3GetIntervalDecimal)
NONE(fmi3GetIntervalFraction)
NONE(fmi3GetNominalsOfContinuousStates)
NONE(fmi3GetNumberOfContinuousStates)
NONE(fmi3GetNumberOfEventIndicators)
NONE(fmi3GetNumberOfVariableDependencies)
NONE(fmi3GetOutputDerivatives)
NONE(fmi3GetShiftDecimal)
NONE(fmi3GetShiftFraction)
NONE(fmi3GetString)
NONE(fmi3GetUInt16)
NONE(fmi3GetUInt32)
NONE(fmi3GetUInt64)
NONE(fmi3GetUInt8)
NONE(fmi3GetVariableDependencies)
NONE(fmi3InstantiateModelExchange)
NONE(fmi3InstantiateScheduledExecution)
NONE(fmi3SerializeFMUState)
NONE(fmi3SerializedFMUStateSize)
NONE(fmi3SetBinary)
NONE(fmi3SetClock)
NONE(fmi3SetContinuousStates)
NONE(fmi3SetDebugLogging)
NONE(fmi3SetFloat32)
NONE(fmi3SetInt16)
NONE(fmi3SetInt64)
NONE(fmi3SetInt8)
NONE(fmi3SetIntervalDecimal)
NONE(fmi3SetIntervalFraction)
NONE(fmi3SetShiftDecimal)
NONE(fmi3SetShiftFraction)
NONE(fmi3SetString)
NONE(fmi3SetTime)
NONE(fmi3SetUInt16)
NONE(fmi3SetUInt32)
NONE(fmi3SetUInt64)
NONE(fmi3SetUInt8)
NONE(fmi3UpdateDiscreteStates)
