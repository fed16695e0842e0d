/* What lets one text be C++ and OpenCL C 1.2.

   In C++ a formula is a template over Real: float, double, or a SIMD pack (a value per lane). In OpenCL C it is a plain
   function over `Real`, a vector of SQUALL_LANES or a single one of `Scalar`, the element type: what the parameter
   structs hold, float or double.

   Rules for everything below kernels/: no branch on data in a formula, only + - * / sqrt, fma and max0; fused
   multiply-adds are written as fma() and the compiler may not invent others; constants are small integers, so that
   every type rounds them alike, or come from a parameter struct. */
#ifndef SQUALL_SHARED_H
#define SQUALL_SHARED_H

#ifdef __cplusplus

#include <cmath>
#include <cstdint>
#include <cstring>

namespace squall {

using std::fma;
using std::sqrt;

/* max(x, 0) as the signed maximum of the bits: one integer instruction in every width; -0 and every negative value,
   NaN with the sign bit included, become +0. */
inline float max0(float x) {
  std::int32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  bits = bits > 0 ? bits : 0;
  std::memcpy(&x, &bits, sizeof bits);
  return x;
}
inline double max0(double x) {
  std::int64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  bits = bits > 0 ? bits : 0;
  std::memcpy(&x, &bits, sizeof bits);
  return x;
}

/* fma(-a, b, c) and fma(a, b, -c): one instruction where a type has one, the same bits everywhere. */
inline float nfma(float a, float b, float c) { return fma(-a, b, c); }
inline double nfma(double a, double b, double c) { return fma(-a, b, c); }
inline float fms(float a, float b, float c) { return fma(a, b, -c); }
inline double fms(double a, double b, double c) { return fma(a, b, -c); }

}  // namespace squall

#define SQUALL_NAMESPACE_BEGIN namespace squall {
#define SQUALL_NAMESPACE_END }
#if defined(__GNUC__)
#define SQUALL_INLINE inline __attribute__((always_inline))
#else
#define SQUALL_INLINE inline
#endif
#define SQUALL_FORMULA  \
  template <class Real> \
  SQUALL_INLINE
#define SQUALL_SCALAR_FORMULA \
  template <class Scalar>     \
  SQUALL_INLINE
#define SQUALL_PARAMS_FORMULA         \
  template <class Real, class Scalar> \
  SQUALL_INLINE
#define SQUALL_STRUCT(name) \
  template <class Scalar>   \
  struct name
#define SQUALL_STRUCT_END(name)
#define SQUALL_CONSTANT const
#define SQUALL_REF(name) name<Scalar>

#else /* OpenCL C */

#pragma OPENCL FP_CONTRACT OFF

#define nfma(a, b, c) fma(-(a), (b), (c))
#define fms(a, b, c) fma((a), (b), -(c))
#ifndef SQUALL_DOUBLE /* 1: double precision */
#define SQUALL_DOUBLE 0
#endif
#ifndef SQUALL_LANES /* particles per vector: 1, 8 or 16; in double precision 1, 4 or 8 */
#define SQUALL_LANES 1
#endif
#if SQUALL_LANES > 1 && defined(__clang__)
/* A processor without such wide registers passes vectors otherwise; all that pass them are compiled for it alike. */
#pragma clang diagnostic ignored "-Wpsabi"
#endif
#if SQUALL_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double Scalar;
typedef double2 Scalar2;
typedef double4 Scalar4;
typedef double8 Scalar8;
#define convert_scalar_rte convert_double_rte
#if SQUALL_LANES == 8
typedef double8 Real;
#define max0(x) as_double8(max(as_long8(x), (long8)(0)))
#elif SQUALL_LANES == 4
typedef double4 Real;
#define max0(x) as_double4(max(as_long4(x), (long4)(0)))
#else
typedef double Real;
#define max0(x) as_double(max(as_long(x), 0L))
#endif
#else
typedef float Scalar;
typedef float2 Scalar2;
typedef float4 Scalar4;
typedef float8 Scalar8;
#define convert_scalar_rte convert_float_rte
#if SQUALL_LANES == 16
typedef float16 Real;
#define max0(x) as_float16(max(as_int16(x), (int16)(0)))
#elif SQUALL_LANES == 8
typedef float8 Real;
#define max0(x) as_float8(max(as_int8(x), (int8)(0)))
#else
typedef float Real;
#define max0(x) as_float(max(as_int(x), 0))
#endif
#endif
#define SQUALL_NAMESPACE_BEGIN
#define SQUALL_NAMESPACE_END
#define SQUALL_INLINE static inline
#define SQUALL_FORMULA static inline
#define SQUALL_SCALAR_FORMULA static inline
#define SQUALL_PARAMS_FORMULA static inline
#define SQUALL_STRUCT(name) typedef struct
#define SQUALL_STRUCT_END(name) name
#define SQUALL_CONSTANT __constant
#define SQUALL_REF(name) name

#endif
#endif
