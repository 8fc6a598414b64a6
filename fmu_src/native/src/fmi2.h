/* Types and functions of FMI 2.0 co-simulation, as the standard names them. */
#ifndef ALI3_FMI2_H
#define ALI3_FMI2_H
#include <stddef.h>

/* A host that links several FMUs statically gives FMI2_FUNCTION_PREFIX; a library exports the plain names. */
#if defined(FMI2_FUNCTION_PREFIX)
#define FMI2_EXPORT
#define FMI2_PASTE(a, b) a##b
#define FMI2_JOIN(a, b) FMI2_PASTE(a, b)
#define FMI2_NAME(name) FMI2_JOIN(FMI2_FUNCTION_PREFIX, name)
#elif defined(_WIN32)
#define FMI2_EXPORT __declspec(dllexport)
#define FMI2_NAME(name) name
#else
#define FMI2_EXPORT __attribute__((visibility("default")))
#define FMI2_NAME(name) name
#endif

typedef void *fmi2Component;
typedef void *fmi2ComponentEnvironment;
typedef void *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef const char *fmi2String;
typedef char fmi2Byte;

typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated } fmi2StatusKind;

typedef struct {
  void (*logger)(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...);
  void *(*allocateMemory)(size_t, size_t);
  void (*freeMemory)(void *);
  void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
  fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;
#endif
