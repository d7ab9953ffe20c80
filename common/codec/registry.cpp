#include "codec/registry.hpp"

#include <algorithm>
#include <array>

#include "codec/acoustic/evologics.hpp"
#include "codec/air/ascii_air_data.hpp"
#include "codec/air/nmea_air_data.hpp"
#include "codec/altimeter/ascii_altitude.hpp"
#include "codec/altimeter/ping.hpp"
#include "codec/autopilot/mavlink.hpp"
#include "codec/depth/ascii_depth.hpp"
#include "codec/depth/paroscientific.hpp"
#include "codec/dvl/nortek.hpp"
#include "codec/dvl/pd0.hpp"
#include "codec/dvl/pd6.hpp"
#include "codec/dvl/waterlinked.hpp"
#include "codec/heading/nmea_attitude.hpp"
#include "codec/imu/kvh.hpp"
#include "codec/imu/microstrain.hpp"
#include "codec/imu/sbg.hpp"
#include "codec/imu/stim300.hpp"
#include "codec/imu/vectornav.hpp"
#include "codec/imu/xsens.hpp"
#include "codec/range/micromodem.hpp"
#include "codec/satellite/gpsd.hpp"
#include "codec/satellite/novatel/novatel.hpp"
#include "codec/satellite/sbf/sbf.hpp"
#include "codec/satellite/ubx.hpp"
#include "codec/text/fix_text.hpp"
#include "codec/text/nmea.hpp"

namespace fathom::codec {
namespace {

constexpr std::array<std::string_view, 16> kNmeaAliases{"nmea",
                                                        "nmea_0183",
                                                        "nmea0183_gps",
                                                        "nmea0183_depth_heading",
                                                        "nmea183",
                                                        "gps_nmea",
                                                        "nmea_gps",
                                                        "nmea_heading",
                                                        "heading",
                                                        "heading_nmea",
                                                        "hdt",
                                                        "rpm",
                                                        "nmea_rpm",
                                                        "actuator",
                                                        "nmea0183_heading",
                                                        "nmea0183_rpm"};
constexpr std::array<std::string_view, 5> kUbxAliases{"ublox", "u_blox", "ubx_nav_pvt", "nav_pvt", "gps_ubx"};
constexpr std::array<std::string_view, 4> kSbfAliases{"septentrio", "septentrio_sbf", "mosaic", "gps_sbf"};
constexpr std::array<std::string_view, 5> kPd0Aliases{"teledyne_pd0", "rdi", "rdi_pd0", "workhorse",
                                                      "dvl_pd0"};
constexpr std::array<std::string_view, 5> kPd6Aliases{"teledyne_pd6", "rdi_pd6", "dvl_pd6", "wayfinder_pd6",
                                                      "navquest"};
constexpr std::array<std::string_view, 5> kWaterlinkedAliases{"waterlinked_json", "water_linked", "a50",
                                                              "a125", "water_linked_json"};
constexpr std::array<std::string_view, 3> kNortekAliases{"nortek_dvl", "df21", "ad2cp_dvl"};
constexpr std::array<std::string_view, 4> kVectornavAliases{"vn", "vnbin", "vectornav_binary",
                                                            "imu_vectornav"};
constexpr std::array<std::string_view, 4> kXsensAliases{"xsens_mti", "mti", "mtdata2", "xbus"};
constexpr std::array<std::string_view, 3> kSbgAliases{"sbgecom", "sbg_ecom", "sbg_ellipse"};
constexpr std::array<std::string_view, 4> kMicroStrainAliases{"mip", "microstrain_mip", "lord_microstrain",
                                                              "3dm"};
constexpr std::array<std::string_view, 2> kStim300Aliases{"stim", "sensonor_stim300"};
constexpr std::array<std::string_view, 4> kKvhAliases{"kvh_1750", "kvh_1775", "kvh_1725", "kvh_imu"};
constexpr std::array<std::string_view, 4> kParoscientificAliases{"pressure", "digiquartz", "paros",
                                                                 "pressure_paroscientific"};
constexpr std::array<std::string_view, 3> kAsciiDepthAliases{"ascii", "depth_line", "ascii_line"};
constexpr std::array<std::string_view, 4> kPsimssbAliases{"usbl", "kongsberg", "kongsberg_psimssb", "hipap"};
constexpr std::array<std::string_view, 3> kPsonlldAliases{"sonardyne", "ranger2", "mini_ranger2"};
constexpr std::array<std::string_view, 3> kEvologicsAliases{"s2c", "evologics_s2c", "usbllong"};
constexpr std::array<std::string_view, 2> kAsciiAirDataAliases{"air_data", "air_data_line"};
constexpr std::array<std::string_view, 3> kNmeaAirDataAliases{"air_data_nmea", "openvario",
                                                              "nmea0183_air_data"};

constexpr std::array<std::string_view, 8> kNmeaAttitudeAliases{
    "attitude", "pashr", "psat_hpr", "ptnthpr", "ohpr", "oceanserver", "prdid", "nmea0183_attitude"};
constexpr std::array<std::string_view, 2> kAsciiAltitudeAliases{"altitude_line", "ascii_altimeter"};
constexpr std::array<std::string_view, 5> kPingAliases{"ping1d", "ping2", "ping_protocol", "cerulean",
                                                       "bluerobotics_ping"};
constexpr std::array<std::string_view, 2> kFixTextAliases{"fix", "pfthx"};
constexpr std::array<std::string_view, 2> kMavlinkAliases{"ardusub", "mavlink2"};
constexpr std::array<std::string_view, 5> kNovatelAliases{"oem6", "oem7", "novatel_oem7", "novatel_binary",
                                                          "bestpos"};
constexpr std::array<std::string_view, 1> kGpsdAliases{"gpsd_json"};
constexpr std::array<std::string_view, 3> kMicromodemAliases{"whoi", "whoi_micromodem", "micro_modem"};

constexpr std::string_view kXsensDescription =
    "Xsens MTi, MTData2 with rate of turn and acceleration or increments, GNSS PVT";
constexpr std::string_view kMicroStrainDescription =
    "MicroStrain 3DM, MIP packets with angular rate and acceleration or increments, or a satellite fix";
constexpr std::string_view kSbgDescription =
    "SBG Systems sbgECom with IMU_SHORT or IMU_DATA, GPS1_POS and GPS1_VEL, or GPS1_HDT";
constexpr std::string_view kNovatelDescription =
    "NovAtel OEM6 and OEM7 binary: BESTPOS and BESTVEL, HEADING2 or DUALANTENNAHEADING";
constexpr std::string_view kNmeaAttitudeDescription =
    "headings of attitude sentences: PASHR, PSAT,HPR, PTNTHPR, OHPR and $C of OceanServer, PRDID";
constexpr std::string_view kPingDescription =
    "echo sounders of Blue Robotics (Ping1D, Ping2) and Cerulean (S500), Ping protocol";
constexpr std::string_view kNoGreeting;

const auto kProtocols = std::to_array<Protocol>({
    {"nmea0183", kNmeaAliases, kNmeaDescription, make_nmea0183, DeviceClock::none},
    {"ubx",
     kUbxAliases,
     "u-blox UBX NAV-PVT, and NAV-RELPOSNED of a moving base",
     make_ubx,
     DeviceClock::utc,
     kNoGreeting,
     {.heading_by_antennas = true}},
    {"novatel",
     kNovatelAliases,
     kNovatelDescription,
     make_novatel,
     DeviceClock::utc,
     kNoGreeting,
     {.heading_by_antennas = true}},
    {"sbf",
     kSbfAliases,
     "Septentrio SBF PVTGeodetic with covariances, and AttEuler of two antennas",
     make_sbf,
     DeviceClock::utc,
     kNoGreeting,
     {.heading_by_antennas = true}},
    {"pd0", kPd0Aliases, "Teledyne RDI PD0 ensembles with bottom track", make_pd0, DeviceClock::counter},
    {"pd6", kPd6Aliases, "Teledyne RDI PD6 lines: Wayfinder, Pathfinder, NavQuest, Water Linked", make_pd6,
     DeviceClock::counter},
    {"waterlinked", kWaterlinkedAliases, "Water Linked A50 and A125, JSON lines", make_waterlinked,
     DeviceClock::counter},
    {"nortek", kNortekAliases, "Nortek DVL, binary bottom and water track (DF21, DF22)", make_nortek,
     DeviceClock::counter},
    {"vectornav",
     kVectornavAliases,
     "VectorNav binary messages with inertial data or GNSS fixes",
     make_vectornav,
     DeviceClock::counter,
     kNoGreeting,
     {.fixes_have_utc = true}},
    {"xsens",
     kXsensAliases,
     kXsensDescription,
     make_xsens,
     DeviceClock::counter,
     kNoGreeting,
     {.turns_axes = true, .fixes_have_utc = true}},
    {"microstrain",
     kMicroStrainAliases,
     kMicroStrainDescription,
     make_microstrain,
     DeviceClock::counter,
     kNoGreeting,
     {.fixes_have_utc = true}},
    {"sbg",
     kSbgAliases,
     kSbgDescription,
     make_sbg,
     DeviceClock::counter,
     kNoGreeting,
     {.fixes_have_utc = true, .heading_by_antennas = true}},
    {"stim300", kStim300Aliases, "Safran Sensonor STIM300, rate and acceleration or increments", make_stim300,
     DeviceClock::none},
    {"kvh", kKvhAliases, "KVH 1725, 1750, 1775: acceleration, and rates or delta angles", make_kvh,
     DeviceClock::none},
    {"paroscientific", kParoscientificAliases, "Paroscientific Digiquartz pressure", make_paroscientific,
     DeviceClock::none},
    {"ascii_depth", kAsciiDepthAliases, "one depth or pressure a line, prefix, scale and offset configurable",
     make_ascii_depth, DeviceClock::none},
    {"ascii_altitude", kAsciiAltitudeAliases,
     "one height above the bottom a line, prefix, scale and offset configurable", make_ascii_altitude,
     DeviceClock::none},
    {"psimssb", kPsimssbAliases, "Kongsberg $PSIMSSB acoustic positions", make_psimssb, DeviceClock::utc},
    {"psonlld", kPsonlldAliases, "Sonardyne $PSONLLD acoustic positions", make_psonlld, DeviceClock::utc},
    {"evologics",
     kEvologicsAliases,
     "EvoLogics S2C modems with a USBL head: USBLLONG",
     make_evologics,
     DeviceClock::none,
     kNoGreeting,
     {.tells_age = true}},
    {"ascii_air_data", kAsciiAirDataAliases, "air data a line, columns and units configurable",
     make_ascii_air_data, DeviceClock::none},
    {"nmea_air_data", kNmeaAirDataAliases, "air data as NMEA 0183 XDR, MWV, VWR or OpenVario $POV",
     make_nmea_air_data, DeviceClock::none},
    {"nmea_attitude", kNmeaAttitudeAliases, kNmeaAttitudeDescription, make_nmea_attitude, DeviceClock::none},
    {"micromodem", kMicromodemAliases, "WHOI Micro-Modem ranges to modems and transponders", make_micromodem,
     DeviceClock::none},
    {"ping", kPingAliases, kPingDescription, make_ping, DeviceClock::none, kPingGreeting},
    {"gpsd", kGpsdAliases, "reports of gpsd, JSON over TCP", make_gpsd, DeviceClock::none, kGpsdGreeting},
    {"mavlink", kMavlinkAliases, "telemetry of an autopilot, MAVLink 1 and 2", make_mavlink,
     DeviceClock::counter},
    {"fix_text", kFixTextAliases, "positions told, one a line: $PFTHX", make_fix_text, DeviceClock::utc},
});

char folded(char c) {
  if (c == '-') return '_';
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool same_name(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return folded(x) == folded(y); });
}

}  // namespace

std::span<const Protocol> protocols() {
  return kProtocols;
}

const Protocol* find_protocol(std::string_view name) {
  for (const Protocol& protocol : kProtocols) {
    if (same_name(protocol.name, name)) return &protocol;
    for (const std::string_view alias : protocol.aliases) {
      if (same_name(alias, name)) return &protocol;
    }
  }
  return nullptr;
}

}  // namespace fathom::codec
