#include "live/doctor/host.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <fstream>
#include <set>
#include <string>
#include <string_view>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/timex.h>
#include <unistd.h>

#include "bus/interfaces.hpp"
#include "runtime/build_info.hpp"

namespace fathom::cli {
namespace {

namespace fs = std::filesystem;

bool is_number(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
}

/// The inodes that a process has mapped or open; false when it may not be looked at.
bool collect_inodes(const fs::path& process, std::set<ino_t>& inodes) {
  std::ifstream maps(process / "maps");
  if (!maps) return false;
  for (std::string line; std::getline(maps, line);) {
    if (line.find("fastrtps") == std::string::npos) continue;
    // address perms offset dev inode path
    std::size_t at = 0;
    for (int field = 0; field < 4; ++field) at = line.find(' ', line.find_first_not_of(' ', at));
    inodes.insert(std::strtoull(line.c_str() + at, nullptr, 10));
  }
  std::error_code error;
  fs::directory_iterator files(process / "fd", error);
  if (error) return false;
  for (const auto& file : files) {
    struct stat status {};
    if (::stat(file.path().c_str(), &status) == 0) inodes.insert(status.st_ino);
  }
  return true;
}

std::optional<std::uint64_t> number_in(const char* path) {
  std::ifstream file(path);
  std::uint64_t value = 0;
  if (!(file >> value)) return std::nullopt;
  return value;
}

std::optional<std::uint64_t> limit_of(__rlimit_resource_t resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return std::nullopt;
  return limit.rlim_cur;
}

}  // namespace

std::vector<ShmLeftover> find_leftovers(const fs::path& shared_memory, const fs::path& processes) {
  constexpr std::chrono::seconds kYoung(10);  // one that is being set up may not be mapped yet
  std::set<ino_t> used;
  std::set<uid_t> hidden;  // users of whose processes some could not be looked at
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(processes, error)) {
    const std::string pid = entry.path().filename().string();
    if (!is_number(pid) || pid == "1") continue;  // init may be closed to everyone, and is no service
    struct stat status {};
    if (::stat(entry.path().c_str(), &status) != 0) continue;  // it ended
    if (!collect_inodes(entry.path(), used) && fs::exists(entry.path())) hidden.insert(status.st_uid);
  }
  std::vector<ShmLeftover> out;
  const auto now = std::chrono::system_clock::now();
  for (const auto& entry : fs::directory_iterator(shared_memory, error)) {
    const std::string name = entry.path().filename().string();
    if (name.find("fastrtps_") == std::string::npos) continue;
    struct stat status {};
    if (::lstat(entry.path().c_str(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
    const auto made = std::chrono::system_clock::from_time_t(status.st_mtime);
    if (now - made < kYoung || used.count(status.st_ino) != 0 || hidden.count(status.st_uid) != 0) continue;
    out.push_back({entry.path().string(), static_cast<std::uint64_t>(status.st_size)});
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return out;
}

std::vector<ShmLeftover> remove_leftovers(const std::vector<ShmLeftover>& leftovers) {
  std::vector<ShmLeftover> kept;
  for (const ShmLeftover& one : leftovers) {
    if (::unlink(one.path.c_str()) != 0) kept.push_back(one);
  }
  return kept;
}

HostFacts look_at_host() {
  HostFacts out;
  out.name = runtime::host_name();
  out.addresses = bus::local_addresses();
  timex clock{};
  if (adjtimex(&clock) >= 0) {
    out.clock_disciplined = (clock.status & STA_UNSYNC) == 0;
    if (*out.clock_disciplined) out.clock_error_s = static_cast<double>(clock.maxerror) * 1e-6;
  }
  struct statvfs memory {};
  if (::statvfs("/dev/shm", &memory) == 0)
    out.shm_free_bytes = std::uint64_t{memory.f_bavail} * memory.f_frsize;
  out.shm_leftovers = find_leftovers("/dev/shm", "/proc");
  out.open_files = limit_of(RLIMIT_NOFILE);
  out.receive_buffer_bytes = number_in("/proc/sys/net/core/rmem_max");
  if (const auto priority = limit_of(RLIMIT_RTPRIO)) {
    out.realtime_priority = geteuid() == 0 ? 99 : static_cast<int>(std::min<std::uint64_t>(*priority, 99));
  }
  return out;
}

}  // namespace fathom::cli
