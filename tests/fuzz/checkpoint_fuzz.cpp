// The file of a checkpoint, with its checksum made right each time: label, lengths and image are reached. The
// first byte chooses a state; where its highest bit is set the rest is the file itself behind its head.

#include <zlib.h>

#include "archive/checkpoint.hpp"
#include "driver.hpp"
#include "state_fuzz.hpp"

namespace {

using fathom::archive::CheckpointLabel;

constexpr std::size_t kSummed = 16;  // behind magic word, format and checksum

CheckpointLabel label() {
  return {"auv", "fusion", "0123456789abcdef", "0.1.0-89abcdef", 1'700'000'000 * fathom::kNsPerSecond};
}

void make_right(std::vector<std::byte>& file) {
  if (file.size() < kSummed) return;
  const auto* data = reinterpret_cast<const Bytef*>(file.data() + kSummed);
  const auto sum = static_cast<std::uint32_t>(crc32_z(crc32_z(0, nullptr, 0), data, file.size() - kSummed));
  for (std::size_t i = 0; i < 4; ++i) file[kSummed - 4 + i] = static_cast<std::byte>(sum >> (8 * i) & 0xFFU);
}

}  // namespace

std::string_view fathom::fuzz::target_name() {
  return "checkpoint";
}

std::vector<std::uint8_t> fathom::fuzz::target_seed() {
  std::vector<std::uint8_t> out(1 + 10 * 20);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::uint8_t>(i * 197);
  out[0] = 2;
  return out;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fathom::fuzz;
  if (size == 0) return 0;
  fathom::test::EngineState whole = states()[(data[0] & 0x7FU) % states().size()];
  const std::span input(data + 1, size - 1);
  std::vector<std::byte> file;
  fathom::archive::encode(label(), whole.image, file);
  if ((data[0] & 0x80U) != 0) {
    file.resize(kSummed);
    const auto bytes = std::as_bytes(input);
    file.insert(file.end(), bytes.begin(), bytes.end());
  } else {
    whole.image = file;
    file = forged(whole, input);
  }
  make_right(file);
  const auto found = fathom::archive::decode(file);
  if (!found) {
    if (found.error().message.empty()) fail("refused without a reason");
    return 0;
  }
  (void)fathom::archive::objection(found.value().label, label(), 60.0);
  hand_over(whole, found.value().archive);
  return 0;
}
