#pragma once

#include <fstream>
#include <string>

#include <sys/types.h>
#include <unistd.h>

namespace fathom::test {

/// Field `number` of /proc/PID/stat as proc(5) counts them, from 3 on; 0 when there is no such process.
inline double process_stat(pid_t pid, int number) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text, ')');  // the name may hold spaces
  for (int i = 3; i < number; ++i) file >> text;
  double value = 0.0;
  file >> value;
  return value;
}

/// Processor time that a process has had so far.
inline double processor_s(pid_t pid) {
  return (process_stat(pid, 14) + process_stat(pid, 15)) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

inline double resident_MB(pid_t pid) {
  return process_stat(pid, 24) * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

}  // namespace fathom::test
