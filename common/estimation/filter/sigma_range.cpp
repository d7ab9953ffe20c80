#include "estimation/filter/sigma_range.hpp"

#include <algorithm>

namespace fathom::estimation {
namespace {

bool sound_or_unknown(double sigma) {
  return std::isnan(sigma) || sound_sigma(sigma);
}

struct Sigmas {
  bool operator()(const Command& /*order*/) const { return true; }  // objection_to() looks
  bool operator()(const GpsSample& sample) const {
    return std::all_of(sample.position_sigma_N_m.begin(), sample.position_sigma_N_m.end(),
                       sound_or_unknown) &&
           std::all_of(sample.velocity_sigma_N_m_s.begin(), sample.velocity_sigma_N_m_s.end(),
                       sound_or_unknown);
  }
  bool operator()(const DvlSample& sample) const { return sound_or_unknown(sample.sigma_m_s); }
  bool operator()(const DepthSample& sample) const { return sound_or_unknown(sample.sigma_m); }
  bool operator()(const HeadingSample& sample) const { return sound_or_unknown(sample.sigma_rad); }
  bool operator()(const UsblSample& sample) const {
    return sound_or_unknown(sample.sigma_m) && sound_or_unknown(sample.sigma_rad);
  }
  bool operator()(const AirspeedSample& sample) const { return sound_or_unknown(sample.sigma_m_s); }
  bool operator()(const PropulsionSample& /*sample*/) const { return true; }
  bool operator()(const FinsSample& /*sample*/) const { return true; }
};

}  // namespace

bool sound_sigmas(const EventSample& sample) {
  return std::visit(Sigmas{}, sample);
}

}  // namespace fathom::estimation
