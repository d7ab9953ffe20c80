#include <ostream>

#include "exchange/nmea/sentences.hpp"

namespace fathom::exchange {
namespace {

constexpr const char* kTalker = "IN";

void write_sentences(std::ostream& out, const Point& p) {
  out << nmea::gga(kTalker, p);
  out << nmea::rmc(kTalker, p,
                   p.quality == Quality::none ? nmea::Validity::not_valid : nmea::Validity::valid);
  if (known(p.velocity_N_m_s[0]) && known(p.velocity_N_m_s[1])) out << nmea::vtg(kTalker, p);
  if (known(p.sigma_N_m[0])) out << nmea::gst(kTalker, p);
  if (known(p.heading_deg)) out << nmea::hdt(kTalker, p.heading_deg);
}

}  // namespace

void write_nmea(std::ostream& out, const Track& track) {
  for (const Point& point : track.points) write_sentences(out, point);
}

}  // namespace fathom::exchange
