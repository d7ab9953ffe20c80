#include "estimation/filter/sigma_range.hpp"

#include <algorithm>

namespace fathom::estimation {
namespace {

bool sound_or_unknown(double sigma) {
  return std::isnan(sigma) || sound_sigma(sigma);
}
template <std::size_t N>
bool sound_or_unknown(const std::array<double, N>& sigmas) {
  return std::all_of(sigmas.begin(), sigmas.end(), [](double one) { return sound_or_unknown(one); });
}

/// Whatever a sample of any kind calls a sigma.
template <class Sample>
bool sound(const Sample& sample) {
  bool good = true;
  if constexpr (requires { sample.sigma_m; }) good = good && sound_or_unknown(sample.sigma_m);
  if constexpr (requires { sample.depth_sigma_m; }) good = good && sound_or_unknown(sample.depth_sigma_m);
  if constexpr (requires { sample.sigma_m_s; }) good = good && sound_or_unknown(sample.sigma_m_s);
  if constexpr (requires { sample.sigma_rad; }) good = good && sound_or_unknown(sample.sigma_rad);
  if constexpr (requires { sample.position_sigma_N_m; })
    good = good && sound_or_unknown(sample.position_sigma_N_m);
  if constexpr (requires { sample.velocity_sigma_N_m_s; })
    good = good && sound_or_unknown(sample.velocity_sigma_N_m_s);
  return good;
}
bool sound(const Command& /*order*/) {
  return true;  // objection_to() looks
}

}  // namespace

bool sound_sigmas(const EventSample& sample) {
  return std::visit([](const auto& one) { return sound(one); }, sample);
}

}  // namespace fathom::estimation
