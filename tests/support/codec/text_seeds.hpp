#pragma once

#include <array>
#include <string>

#include "base/time.hpp"
#include "sim/encode/nmea.hpp"

namespace fathom::test {

/// The attitude sentence that is followed, and one of each of the others.
inline std::string attitude_sentences(const HeadingSample& heading, TimeNs utc_ns, int frame) {
  const std::string other_deg = std::to_string(37 * frame) + ".5";
  const std::array others{"PSAT,HPR,120000.00," + other_deg + ",,-1.73,N",
                          "PTNTHPR," + other_deg + ",N,-0.9,O,0.8,N",
                          "OHPR," + other_deg + ",-14.3,175.5,30.1",
                          "C" + other_deg + "P0.2R-18.3T19.0Mx-79.4",
                          "PRDID,-0.49,-0.14," + other_deg,
                          std::string("PASHR,POS,0,02,174637.07,,,,,,,,,,,,,,D06E")};
  return sim::encode::nmea_attitude(heading, utc_ns) +
         sim::encode::nmea_sentence(others[static_cast<std::size_t>(frame) % others.size()]);
}

/// Its sky, its statistics, a fix.
inline std::string gpsd_reports(TimeNs utc_ns, int frame) {
  const std::string time = to_iso8601(utc_ns);
  return R"({"class":"GST","device":"/dev/ttyS0","time":")" + time +
         R"(","lat":0.5,"lon":0.6,"alt":1.2})"
         "\r\n"
         R"({"class":"SKY","device":"/dev/ttyS0","hdop":0.90,"uSat":9,"satellites":[{"PRN":2}]})"
         "\r\n"
         R"({"class":"TPV","device":"/dev/ttyS0","mode":3,"time":")" +
         time + R"(","lat":36.4,"lon":-127.3)" + std::to_string(frame) +
         R"(,"altHAE":44.1,"altMSL":18.5,"track":12.5,"speed":1.25,"climb":-0.1,"eps":0.2})"
         "\r\n";
}

}  // namespace fathom::test
