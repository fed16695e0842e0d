/* OpenCL only: what the build options say about the scene, with defaults for a compiler that is given none. Switches
   are integers; constants come in Params. */
#ifndef SQUALL_SWITCHES_H
#define SQUALL_SWITCHES_H

#ifndef SQUALL_WCSPH /* 1: wcsph, 0: mueller */
#define SQUALL_WCSPH 1
#endif
#ifndef SQUALL_DFSPH /* 1: dfsph, with the bell kernel */
#define SQUALL_DFSPH 0
#endif
#ifndef SQUALL_WEIGHTS /* dfsph with blocks: there is room to keep weights of pairs */
#define SQUALL_WEIGHTS 1
#endif
#ifndef SQUALL_SMOOTHING /* dfsph: the scene asks for xsph */
#define SQUALL_SMOOTHING 1
#endif
#ifndef SQUALL_VISCOSITY /* the scene names a viscosity */
#define SQUALL_VISCOSITY 1
#endif
#ifndef SQUALL_BOXES /* the scene has solid boxes */
#define SQUALL_BOXES 1
#endif
#ifndef SQUALL_DRAG /* the scene has rain */
#define SQUALL_DRAG 1
#endif

#if SQUALL_WCSPH
#define SQUALL_DENSITY_KERNEL SQUALL_CUBIC
#define SQUALL_FORCE_KERNEL SQUALL_CUBIC
#else
#define SQUALL_DENSITY_KERNEL SQUALL_POLY6
#define SQUALL_FORCE_KERNEL SQUALL_SPIKY
#endif

#endif
