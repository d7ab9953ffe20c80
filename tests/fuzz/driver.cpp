// Runs a fuzz target without libFuzzer: over the files named on the command line, else over mutations of the
// target's seed for `--seconds N` (default 2), and never fewer than a hundred, from `--seed N` (default 1).
// The same seed gives the same inputs; on a failure the input is left in the working directory.

#include "driver.hpp"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <unistd.h>

#include "support/codec/seed_streams.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using fathom::test::ByteVector;

// For the handler of a crash, which may not allocate.
const ByteVector* current = nullptr;
std::array<char, 128> crash_file{};

void save_and_die(int signal) {
  if (current != nullptr) {
    if (std::FILE* file = std::fopen(crash_file.data(), "wb"); file != nullptr) {
      (void)std::fwrite(current->data(), 1, current->size(), file);
      (void)std::fclose(file);
    }
  }
  std::signal(signal, SIG_DFL);
  (void)std::raise(signal);
}

void run(const ByteVector& input) {
  current = &input;
  alarm(20);  // an input that takes longer hangs
  (void)LLVMFuzzerTestOneInput(input.data(), input.size());
  alarm(0);
  current = nullptr;
}

ByteVector read(const char* path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    (void)std::fprintf(stderr, "%s: cannot be read\n", path);
    std::exit(3);
  }
  return {std::istreambuf_iterator<char>(in), {}};
}

/// However busy the machine is.
constexpr std::uint64_t kFewest = 100;

std::uint64_t run_mutations(std::uint64_t first_seed, double seconds) {
  using Clock = std::chrono::steady_clock;
  const ByteVector stream = fathom::fuzz::target_seed();
  // What a target makes once, for its first input, is not part of the time.
  run({});
  run(stream);
  const auto end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  std::uint64_t seed = first_seed;
  for (; seed - first_seed < kFewest || Clock::now() < end; ++seed) {
    // Mostly a few errors, sometimes hardly a good byte, sometimes nothing but noise.
    if (seed % 16 == 0) {
      run(fathom::test::noise(seed % 5000, seed));
    } else {
      run(fathom::test::mutated(stream, seed % 8 == 1 ? 200 : 1 + seed % 12, seed));
    }
  }
  return seed - first_seed;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<const char*> files;
  std::uint64_t seed = 1;
  double seconds = 2.0;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--seed" && i + 1 < argc) {
      seed = std::strtoull(argv[++i], nullptr, 10);
    } else if (word == "--seconds" && i + 1 < argc) {
      seconds = std::strtod(argv[++i], nullptr);
    } else {
      files.push_back(argv[i]);
    }
  }
  const std::string name(fathom::fuzz::target_name());
  (void)std::snprintf(crash_file.data(), crash_file.size(), "crash-%s", name.c_str());
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGALRM}) std::signal(signal, save_and_die);
  for (const char* file : files) run(read(file));
  const std::uint64_t inputs = files.empty() ? run_mutations(seed, seconds) : files.size();
  std::printf("%s: %llu inputs\n", name.c_str(), static_cast<unsigned long long>(inputs));
  return inputs == 0 ? 1 : 0;
}
