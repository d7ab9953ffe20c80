// The state of an engine, as a replica takes it from the network: the first byte chooses one to forge; where
// its highest bit is set the rest is the image itself.

#include "driver.hpp"
#include "state_fuzz.hpp"

std::string_view fathom::fuzz::target_name() {
  return "engine_state";
}

std::vector<std::uint8_t> fathom::fuzz::target_seed() {
  std::vector<std::uint8_t> out(1 + 10 * 20);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::uint8_t>(i * 151);
  out[0] = 1;
  return out;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fathom::fuzz;
  if (size == 0) return 0;
  const auto& state = states()[(data[0] & 0x7FU) % states().size()];
  const std::span input(data + 1, size - 1);
  if ((data[0] & 0x80U) != 0) {
    hand_over(state, std::as_bytes(input));
  } else {
    hand_over(state, forged(state, input));
  }
  return 0;
}
