#include "backend_opencl/shared_memory.h"

#include <cstring>
#include <vector>

#include "backend_opencl/buffers.h"
#include "backend_opencl/kernel_arguments.h"

namespace squall::opencl {

bool shares_host_memory(Machine& machine, const cl::Program& program) {
  if (!machine.device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>()) return false;
  constexpr std::size_t k_words = 4096;
  constexpr cl_uint k_patterns[] = {0x5eed0001u, 0xa5a50003u};
  const Pages pages = allocate_pages(k_words * sizeof(cl_uint));
  const cl::Buffer buffer(machine.context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, k_words * sizeof(cl_uint),
                          pages.get());
  cl::Kernel kernel(program, "probe_memory");
  std::vector<cl_uint> seen(k_words);
  for (const cl_uint pattern : k_patterns) {
    set_arguments(kernel, buffer, pattern);
    machine.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(k_words), cl::NDRange(64));
    machine.queue.finish();
    // Not mapped: only a device that works on this very memory has changed it.
    std::memcpy(seen.data(), pages.get(), k_words * sizeof(cl_uint));
    for (std::size_t i = 0; i < k_words; ++i)
      if (seen[i] != pattern + static_cast<cl_uint>(i)) return false;
  }
  return true;
}

}  // namespace squall::opencl
