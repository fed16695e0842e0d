// A library to be preloaded: calls into OpenCL and for memory fail where a test asks for it, as a device that is lost
// or full makes them fail. SQUALL_FAULT is "FUNCTION CODE CALL": from its CALL-th call (from 1) on, FUNCTION returns
// CODE. "clGetDeviceInfo BYTES 1" makes every device say that it allows no larger buffer. Everything else goes where it
// would go.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace {

struct Fault {
  const char* function = "";
  std::size_t length = 0;
  int code = 0;
  long first_call = 0;
  std::atomic<long> calls = 0;

  Fault() {
    const char* text = std::getenv("SQUALL_FAULT");
    if (text == nullptr || std::strchr(text, ' ') == nullptr) return;
    function = text;
    length = std::strcspn(text, " ");
    char* rest = nullptr;
    code = static_cast<int>(std::strtol(text + length, &rest, 10));
    first_call = std::strtol(rest, nullptr, 10);
  }

  /// Counts a call; whether it shall fail.
  bool strikes(const char* name) {
    if (length == 0 || std::strlen(name) != length || std::strncmp(name, function, length) != 0) return false;
    return ++calls >= first_call;
  }
};

Fault& fault() {
  static Fault one;
  return one;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

#define SQUALL_FAULTY(name, parameters, arguments)         \
  cl_int CL_API_CALL name parameters {                     \
    if (fault().strikes(#name)) return fault().code;       \
    static auto* const real = next<decltype(name)>(#name); \
    return real arguments;                                 \
  }

extern "C" {

SQUALL_FAULTY(clGetDeviceIDs,
              (cl_platform_id platform, cl_device_type type, cl_uint room, cl_device_id* devices, cl_uint* count),
              (platform, type, room, devices, count))
SQUALL_FAULTY(clBuildProgram,
              (cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
               void(CL_CALLBACK* notify)(cl_program, void*), void* data),
              (program, count, devices, options, notify, data))
SQUALL_FAULTY(clEnqueueNDRangeKernel,
              (cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const std::size_t* offset,
               const std::size_t* global, const std::size_t* local, cl_uint waits, const cl_event* wait,
               cl_event* event),
              (queue, kernel, dimensions, offset, global, local, waits, wait, event))
SQUALL_FAULTY(clEnqueueReadBuffer,
              (cl_command_queue queue, cl_mem buffer, cl_bool blocking, std::size_t offset, std::size_t size,
               void* memory, cl_uint waits, const cl_event* wait, cl_event* event),
              (queue, buffer, blocking, offset, size, memory, waits, wait, event))
SQUALL_FAULTY(clEnqueueWriteBuffer,
              (cl_command_queue queue, cl_mem buffer, cl_bool blocking, std::size_t offset, std::size_t size,
               const void* memory, cl_uint waits, const cl_event* wait, cl_event* event),
              (queue, buffer, blocking, offset, size, memory, waits, wait, event))
SQUALL_FAULTY(clWaitForEvents, (cl_uint count, const cl_event* events), (count, events))
SQUALL_FAULTY(clFinish, (cl_command_queue queue), (queue))

cl_mem CL_API_CALL clCreateBuffer(cl_context context, cl_mem_flags flags, std::size_t size, void* memory,
                                  cl_int* error) {
  if (fault().strikes("clCreateBuffer")) {
    if (error != nullptr) *error = fault().code;
    return nullptr;
  }
  static auto* const real = next<decltype(clCreateBuffer)>("clCreateBuffer");
  return real(context, flags, size, memory, error);
}

cl_int CL_API_CALL clGetDeviceInfo(cl_device_id device, cl_device_info name, std::size_t size, void* value,
                                   std::size_t* size_needed) {
  static auto* const real = next<decltype(clGetDeviceInfo)>("clGetDeviceInfo");
  const cl_int result = real(device, name, size, value, size_needed);
  if (name != CL_DEVICE_MAX_MEM_ALLOC_SIZE || value == nullptr || !fault().strikes("clGetDeviceInfo")) return result;
  const auto bytes = static_cast<cl_ulong>(fault().code);
  std::memcpy(value, &bytes, sizeof bytes);
  return result;
}

/// Only large ones: neighbour lists, not what starts a process.
void* realloc(void* memory, std::size_t size) {
  constexpr std::size_t k_large = std::size_t{1} << 16;
  if (size >= k_large && fault().strikes("realloc")) {
    errno = ENOMEM;
    return nullptr;
  }
  static auto* const real = next<void*(void*, std::size_t)>("realloc");
  return real(memory, size);
}

}  // extern "C"
