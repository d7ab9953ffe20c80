#include "cli/outputs.hpp"

#include <filesystem>
#include <system_error>

#include "cli/command.hpp"
#include "dataset/dataset.hpp"

namespace fathom::cli {
namespace {

namespace fs = std::filesystem;

/// Where a write goes: links are followed, also those whose target is not there yet.
fs::path target_of(fs::path path) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(fs::symlink_status(path, error)); ++i) {
    const fs::path next = fs::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / next;
  }
  fs::path target = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? path : target;
}

bool same(const fs::path& one, const fs::path& other) {
  std::error_code error;
  if (fs::exists(one, error) && fs::exists(other, error)) return fs::equivalent(one, other, error);
  return target_of(one) == target_of(other);
}

/// What takes one output after another: no file is truncated by opening it.
bool is_stream(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) return true;
  const std::string text = path.lexically_normal().string();
  return text == "/dev/stdout" || text == "/dev/stderr" || text.starts_with("/dev/fd/") ||
         text.starts_with("/proc/self/fd/");
}

std::vector<NamedPath> each_file(const std::vector<NamedPath>& paths) {
  std::vector<NamedPath> out;
  for (const NamedPath& one : paths) {
    if (one.path.empty()) continue;
    out.push_back(one);
    std::error_code error;
    const fs::file_status status = fs::status(one.path, error);
    if (!one.data_set || (fs::exists(status) && !fs::is_directory(status))) continue;
    for (const std::string& file : dataset::file_names())
      out.push_back({one.name, (fs::path(one.path) / file).string()});
    out.push_back({one.name, (fs::path(one.path) / "import.json").string()});
  }
  return out;
}

[[noreturn]] void refuse(const NamedPath& output, const NamedPath& other) {
  throw Failure(ExitCode::bad_configuration, output.name + " " + output.path + ": is the same file as " +
                                                 other.name + " " + other.path + ", expected another one");
}

}  // namespace

void refuse_same_files(const std::vector<NamedPath>& inputs, const std::vector<NamedPath>& outputs) {
  const std::vector<NamedPath> read = each_file(inputs);
  const std::vector<NamedPath> written = each_file(outputs);
  for (std::size_t i = 0; i < written.size(); ++i) {
    const NamedPath& output = written[i];
    if (is_stream(output.path)) continue;
    for (const NamedPath& input : read)
      if (same(output.path, input.path)) refuse(output, input);
    for (std::size_t k = 0; k < i; ++k)
      if (same(output.path, written[k].path)) refuse(output, written[k]);
  }
}

}  // namespace fathom::cli
