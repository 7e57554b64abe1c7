// SPDX-License-Identifier: BSD-3-Clause
/// Where a run's time goes, by Teuchos' timers and Kokkos' labels: a library that Kokkos loads when a program starts.
///
///     KOKKOS_PROFILE_LIBRARY=build/test/benchmark/librpc_profiler.so build/rpc --input=beam.xml --set="Output->Timers=true"
///
/// At the end the table goes to the file that RPC_PROFILE names, or else to standard error. With CUPTI: the GPU's own times of
/// all kernels and copies, those of allocations and waiting, and what managed memory moves between host and GPU. Without: the
/// kernels' times on the host's clock, and nothing else. RPC_TRACE names a file for timers, kernels and
/// CUDA's calls one by one, as CSV; starts are seconds since that of the profile.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#ifdef RPC_PROFILER_CUPTI
#include <cupti.h>
#include <cxxabi.h>
#endif

namespace
{

using Time = std::uint64_t; // [ns]

Time now()
{
#ifdef RPC_PROFILER_CUPTI
  Time time = 0;
  cuptiGetTimestamp(&time); // the clock of the GPU's records
  return time;
#else
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
#endif
}

/// Number and sum of what happened: seconds, or bytes.
struct Sum {
  long count = 0;
  double total = 0;
  void add(const double amount)
  {
    ++count;
    total += amount;
  }
};

enum Kind { kernels, copies, allocations, waits, to_gpu, to_host, gpu_faults, host_faults, num_kinds };

/// A timer within others.
struct Region {
  std::string name;
  int parent = -1, depth = 0;
  Sum wall;
  Sum sums[num_kinds];
};

struct Profile {
  std::vector<Region> regions{{"all", -1, 0, {}, {}}};
  std::map<std::pair<int, std::string>, int> child; // of a region, by name
  int current = 0;
  std::vector<Time> entered{now()};
  std::vector<std::pair<Time, int>> changes{{0, 0}}; // since when which region

  std::vector<std::string> labels;
  std::map<std::string, std::uint64_t> label_id;
  std::map<std::string, Sum> by_label;
  std::map<std::uint32_t, std::uint64_t> label_of_launch; // by CUPTI's correlation
  std::FILE *trace = nullptr;
  Time started = 0; // the kernel under way

  void enter(const std::string &name)
  {
    const auto [at, added] = child.try_emplace({current, name}, static_cast<int>(regions.size()));
    if (added) regions.push_back({name, current, regions[current].depth + 1, {}, {}});
    current = at->second;
    entered.push_back(now());
    changes.emplace_back(entered.back(), current);
  }
  void leave()
  {
    if (current == 0) return;
    const Time time = now();
    regions[current].wall.add(1e-9 * (time - entered.back()));
    write("region", entered.back(), time, regions[current].name);
    entered.pop_back();
    current = regions[current].parent;
    changes.emplace_back(time, current);
  }
  void add(const Kind kind, const Time when, const double amount)
  {
    const auto after = std::upper_bound(changes.begin(), changes.end(), std::make_pair(when, 1 << 30));
    for (int r = std::prev(after)->second; r >= 0; r = regions[r].parent) regions[r].sums[kind].add(amount);
  }
  /// @param what  kernel, call or region
  void write(const char *const what, const Time start, const Time end, const std::string &name) const
  {
    if (!trace) return;
    const double since = start < entered.front() ? -1e-9 * (entered.front() - start) : 1e-9 * (start - entered.front());
    std::fprintf(trace, "%s,%.9f,%.9f,\"", what, since, 1e-9 * (end - start));
    for (const char letter : name) {
      if (letter == '"') std::fputc('"', trace); // twice, as CSV has it
      std::fputc(letter, trace);
    }
    std::fputs("\"\n", trace);
  }
  std::uint64_t id_of(const std::string &label)
  {
    const auto [at, added] = label_id.try_emplace(label, labels.size() + 1);
    if (added) labels.push_back(label);
    return at->second;
  }
};
Profile *profile = nullptr;

#ifdef RPC_PROFILER_CUPTI

std::string readable(const char *mangled)
{
  int status = 0;
  char *const name = abi::__cxa_demangle(mangled, nullptr, nullptr, &status);
  std::string text = status == 0 ? name : mangled;
  std::free(name);
  return text.substr(0, 100);
}

void take_call(const CUpti_ActivityAPI &call)
{
  const char *name = "";
  cuptiGetCallbackName(CUPTI_CB_DOMAIN_RUNTIME_API, call.cbid, &name);
  const std::string text = name;
  const double seconds = 1e-9 * (call.end - call.start);
  profile->write("call", call.start, call.end, text);
  if (text.find("Malloc") != std::string::npos || text.find("Free") != std::string::npos)
    profile->add(allocations, call.start, seconds);
  else if (text.find("Synchronize") != std::string::npos)
    profile->add(waits, call.start, seconds);
}

void take_managed(const CUpti_ActivityUnifiedMemoryCounter3 &event)
{
  switch (event.counterKind) {
  case CUPTI_ACTIVITY_UNIFIED_MEMORY_COUNTER_KIND_BYTES_TRANSFER_HTOD:
    return profile->add(to_gpu, event.start, event.value);
  case CUPTI_ACTIVITY_UNIFIED_MEMORY_COUNTER_KIND_BYTES_TRANSFER_DTOH:
    return profile->add(to_host, event.start, event.value);
  case CUPTI_ACTIVITY_UNIFIED_MEMORY_COUNTER_KIND_GPU_PAGE_FAULT:
    return profile->add(gpu_faults, event.start, 1);
  case CUPTI_ACTIVITY_UNIFIED_MEMORY_COUNTER_KIND_CPU_PAGE_FAULT_COUNT:
    return profile->add(host_faults, event.start, 1);
  default:
    return;
  }
}

void take(const CUpti_Activity *const record)
{
  switch (record->kind) {
  case CUPTI_ACTIVITY_KIND_EXTERNAL_CORRELATION: { // comes before its kernel
    const auto &link = *reinterpret_cast<const CUpti_ActivityExternalCorrelation *>(record);
    profile->label_of_launch[link.correlationId] = link.externalId;
    return;
  }
  case CUPTI_ACTIVITY_KIND_CONCURRENT_KERNEL: {
    const auto &kernel = *reinterpret_cast<const CUpti_ActivityKernel10 *>(record);
    const double seconds = 1e-9 * (kernel.end - kernel.start);
    const auto label = profile->label_of_launch.find(kernel.correlationId);
    const std::string name =
        label == profile->label_of_launch.end() ? readable(kernel.name) : profile->labels[label->second - 1];
    profile->add(kernels, kernel.start, seconds);
    profile->by_label[name].add(seconds);
    profile->write("kernel", kernel.start, kernel.end, name);
    return;
  }
  case CUPTI_ACTIVITY_KIND_MEMCPY: {
    const auto &copy = *reinterpret_cast<const CUpti_ActivityMemcpy6 *>(record);
    return profile->add(copies, copy.start, 1e-9 * (copy.end - copy.start));
  }
  case CUPTI_ACTIVITY_KIND_RUNTIME:
    return take_call(*reinterpret_cast<const CUpti_ActivityAPI *>(record));
  case CUPTI_ACTIVITY_KIND_UNIFIED_MEMORY_COUNTER:
    return take_managed(*reinterpret_cast<const CUpti_ActivityUnifiedMemoryCounter3 *>(record));
  default:
    return;
  }
}

// Records wait until the end, so that nothing is sorted while the program runs.
std::vector<std::pair<std::uint8_t *, std::size_t>> buffers;

void CUPTIAPI give_buffer(std::uint8_t **buffer, std::size_t *size, std::size_t *max_records)
{
  *size = 8 << 20;
  *max_records = 0;
  *buffer = static_cast<std::uint8_t *>(std::aligned_alloc(8, *size));
}
void CUPTIAPI keep_buffer(CUcontext, std::uint32_t, std::uint8_t *buffer, std::size_t, const std::size_t valid)
{
  buffers.emplace_back(buffer, valid);
}

void start_records()
{
  cuptiActivityRegisterCallbacks(give_buffer, keep_buffer);
  std::vector<CUpti_ActivityUnifiedMemoryCounterConfig> counters;
  for (const auto kind : {CUPTI_ACTIVITY_UNIFIED_MEMORY_COUNTER_KIND_BYTES_TRANSFER_HTOD,
                          CUPTI_ACTIVITY_UNIFIED_MEMORY_COUNTER_KIND_BYTES_TRANSFER_DTOH,
                          CUPTI_ACTIVITY_UNIFIED_MEMORY_COUNTER_KIND_CPU_PAGE_FAULT_COUNT,
                          CUPTI_ACTIVITY_UNIFIED_MEMORY_COUNTER_KIND_GPU_PAGE_FAULT})
    counters.push_back({CUPTI_ACTIVITY_UNIFIED_MEMORY_COUNTER_SCOPE_PROCESS_SINGLE_DEVICE, kind, 0, 1});
  if (cuptiActivityConfigureUnifiedMemoryCounter(counters.data(), counters.size()) == CUPTI_SUCCESS)
    cuptiActivityEnable(CUPTI_ACTIVITY_KIND_UNIFIED_MEMORY_COUNTER);
  for (const auto kind : {CUPTI_ACTIVITY_KIND_EXTERNAL_CORRELATION, CUPTI_ACTIVITY_KIND_CONCURRENT_KERNEL,
                          CUPTI_ACTIVITY_KIND_MEMCPY, CUPTI_ACTIVITY_KIND_RUNTIME})
    cuptiActivityEnable(kind);
}

void take_records()
{
  cuptiActivityFlushAll(1);
  const auto each = [](const auto &use) {
    for (const auto &[buffer, valid] : buffers)
      for (CUpti_Activity *record = nullptr; cuptiActivityGetNextRecord(buffer, valid, &record) == CUPTI_SUCCESS;)
        use(record);
  };
  each([](const CUpti_Activity *record) {
    if (record->kind == CUPTI_ACTIVITY_KIND_EXTERNAL_CORRELATION) take(record);
  });
  each([](const CUpti_Activity *record) {
    if (record->kind != CUPTI_ACTIVITY_KIND_EXTERNAL_CORRELATION) take(record);
  });
}

#endif

/// @return the label's number
std::uint64_t begin_kernel(const char *label)
{
  if (!profile) return 0;
  const std::uint64_t id = profile->id_of(label);
#ifdef RPC_PROFILER_CUPTI
  cuptiActivityPushExternalCorrelationId(CUPTI_EXTERNAL_CORRELATION_KIND_CUSTOM0, id);
#else
  profile->started = now();
#endif
  return id;
}

void end_kernel(const std::uint64_t id)
{
  if (!profile) return;
#ifdef RPC_PROFILER_CUPTI
  (void)id;
  std::uint64_t last = 0;
  cuptiActivityPopExternalCorrelationId(CUPTI_EXTERNAL_CORRELATION_KIND_CUSTOM0, &last);
#else
  const Time end = now();
  const double seconds = 1e-9 * (end - profile->started);
  profile->add(kernels, profile->started, seconds);
  profile->write("kernel", profile->started, end, profile->labels[id - 1]);
  profile->by_label[profile->labels[id - 1]].add(seconds);
#endif
}

void print_region(std::FILE *out, const int r)
{
  const Region &region = profile->regions[r];
  const Sum *const s = region.sums;
  std::fprintf(out, "%9.4f %6ld %9.4f %8ld %8.4f %7.4f %7ld %7.4f %8.1f %8.1f %8.0f %8.0f  %*s%s\n", region.wall.total,
               region.wall.count, s[kernels].total, s[kernels].count, s[copies].total, s[allocations].total,
               s[allocations].count, s[waits].total, 1e-6 * s[to_gpu].total, 1e-6 * s[to_host].total,
               s[gpu_faults].total, s[host_faults].total, 2 * region.depth, "", region.name.substr(0, 80).c_str());
  std::vector<int> children;
  for (std::size_t c = 1; c < profile->regions.size(); ++c)
    if (profile->regions[c].parent == r && profile->regions[c].wall.total > 2e-3)
      children.push_back(static_cast<int>(c));
  for (const int c : children) print_region(out, c);
}

void print()
{
  const char *const path = std::getenv("RPC_PROFILE");
  std::FILE *const out = path ? std::fopen(path, "w") : stderr;
  if (!out) return;
  std::fprintf(out, "%9s %6s %9s %8s %8s %7s %7s %7s %8s %8s %8s %8s  region\n", "wall [s]", "times", "kernels",
               "launches", "copies", "alloc", "allocs", "waits", "MB->gpu", "MB->host", "flt gpu", "flt host");
  print_region(out, 0);
  std::vector<std::pair<std::string, Sum>> sorted(profile->by_label.begin(), profile->by_label.end());
  std::sort(sorted.begin(), sorted.end(), [](const auto &a, const auto &b) { return a.second.total > b.second.total; });
  std::fprintf(out, "\n%10s %8s  kernel\n", "sum [s]", "launches");
  for (std::size_t k = 0; k < sorted.size() && k < 60; ++k)
    std::fprintf(out, "%10.5f %8ld  %s\n", sorted[k].second.total, sorted[k].second.count, sorted[k].first.c_str());
  if (path) std::fclose(out);
}

} // namespace

/// What Kokkos calls; the signatures are those of Kokkos 3.4's tools interface.
extern "C" {

void kokkosp_init_library(const int, const std::uint64_t, const std::uint32_t, void *)
{
#ifdef RPC_PROFILER_CUPTI
  start_records();
#endif
  profile = new Profile;
  const char *const path = std::getenv("RPC_TRACE");
  if (!path) return;
  profile->trace = std::fopen(path, "w");
  std::fputs(profile->trace ? "what,start [s],seconds,name\n" : "rpc_profiler: RPC_TRACE cannot be written\n",
             profile->trace ? profile->trace : stderr);
}

void kokkosp_finalize_library()
{
  if (!profile) return;
  while (profile->current != 0) profile->leave();
  profile->regions[0].wall.add(1e-9 * (now() - profile->entered[0]));
#ifdef RPC_PROFILER_CUPTI
  take_records();
#endif
  print();
  if (profile->trace) std::fclose(profile->trace);
  delete profile;
  profile = nullptr;
}

void kokkosp_push_profile_region(const char *name)
{
  if (profile) profile->enter(name);
}
void kokkosp_pop_profile_region()
{
  if (profile) profile->leave();
}

void kokkosp_begin_parallel_for(const char *label, const std::uint32_t, std::uint64_t *id)
{
  *id = begin_kernel(label);
}
void kokkosp_begin_parallel_reduce(const char *label, const std::uint32_t, std::uint64_t *id)
{
  *id = begin_kernel(label);
}
void kokkosp_begin_parallel_scan(const char *label, const std::uint32_t, std::uint64_t *id)
{
  *id = begin_kernel(label);
}
void kokkosp_end_parallel_for(const std::uint64_t id)
{
  end_kernel(id);
}
void kokkosp_end_parallel_reduce(const std::uint64_t id)
{
  end_kernel(id);
}
void kokkosp_end_parallel_scan(const std::uint64_t id)
{
  end_kernel(id);
}
}
