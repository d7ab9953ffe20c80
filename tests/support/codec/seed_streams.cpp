#include "support/codec/seed_streams.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "mavlink/frame.hpp"
#include "mavlink/messages.hpp"
#include "sim/encode/air_data.hpp"
#include "sim/encode/altimeter.hpp"
#include "sim/encode/depth.hpp"
#include "sim/encode/dvl/nortek.hpp"
#include "sim/encode/dvl/pd0.hpp"
#include "sim/encode/dvl/pd6.hpp"
#include "sim/encode/dvl/waterlinked.hpp"
#include "sim/encode/evologics.hpp"
#include "sim/encode/imu/microstrain.hpp"
#include "sim/encode/imu/sbg.hpp"
#include "sim/encode/imu/stim300.hpp"
#include "sim/encode/imu/vectornav.hpp"
#include "sim/encode/imu/xsens.hpp"
#include "sim/encode/nmea.hpp"
#include "sim/encode/sbf.hpp"
#include "sim/encode/ubx.hpp"
#include "support/codec/kvh_seed.hpp"
#include "support/codec/novatel_seed.hpp"
#include "support/codec/text_seeds.hpp"

namespace fathom::test {
namespace {

constexpr TimeNs kStart = 1'767'225'599 * kNsPerSecond;  // one second before 2026
constexpr int kFrames = 8;

TimeNs instant(int frame) {
  return kStart + frame * kNsPerSecond / 4;
}

void append(ByteVector& stream, std::string_view text) {
  stream.insert(stream.end(), text.begin(), text.end());
}

void append(ByteVector& stream, const ByteVector& bytes) {
  stream.insert(stream.end(), bytes.begin(), bytes.end());
}

GpsSample gps(int frame) {
  GpsSample sample;
  sample.fix = frame == 3 ? GpsFix::none : GpsFix::differential;
  sample.satellites = 9 + frame;
  sample.hdop = 0.8;
  sample.latitude_rad = 0.635 + frame * 1e-7;
  sample.longitude_rad = -2.223 - frame * 1e-7;
  sample.altitude_m = 18.5;
  sample.altitude_msl_m = -7.0;
  sample.position_sigma_N_m = {0.6, 0.7, 1.4};
  sample.velocity_N_m_s = {1.0 + 0.1 * frame, -0.5, 0.02};
  sample.velocity_sigma_N_m_s = {0.05, 0.05, 0.1};
  return sample;
}

DvlSample dvl(int frame) {
  DvlSample sample;
  constexpr DvlFrame kFrameOf[] = {DvlFrame::instrument, DvlFrame::ship, DvlFrame::beam, DvlFrame::earth};
  sample.recorded_frame = kFrameOf[frame % 4];
  sample.velocity_D_m_s = {1.5, 0.1 * frame, -0.02};
  sample.error_velocity_m_s = 0.004;
  sample.sigma_m_s = 0.005;
  sample.beam_range_m = {30.0, 31.0, 29.5, 30.5};
  sample.altitude_m = 30.0;
  sample.sound_speed_m_s = 1495.0;
  sample.roll_rad = 0.02;
  sample.pitch_rad = -0.03;
  sample.heading_rad = 1.2;
  if (frame == 2) sample.velocity_D_m_s.fill(kUnknown);
  return sample;
}

/// Teledyne's lines, those of Water Linked, and two lines between which the line end was lost.
void pd6_lines(ByteVector& stream, int frame) {
  const DvlSample bottom = dvl(frame);
  DvlSample water = bottom;
  water.velocity_D_m_s = {1.25, 0.5, 0.0};
  append(stream, sim::encode::pd6(bottom, instant(frame), 0.0, frame % 3 == 0 ? &water : nullptr));
  append(stream, ":HM,G,D,0e89,0ffe, 10.842, 1.974, 5.493\r\n");
  if (frame == 4) {
    append(stream,
           ":SA, +0.00, +0.00,  0.00\r\n:TS,22020812061800, 0.0, +0.0,   0.0,1475.0,  0:WI,    +0,    +0,"
           "    +0,    +0,V\r\n:BI,  +123,  -420, +2000,    +0,A\r\n:BS,  -420,  +123, +2000,A\r\n"
           ":BE,    +0,    +0,    +0,V\r\n:BD,       +0.00,       +0.00,       +0.00,   5.32,  0.00\r\n");
  }
}

UsblSample usbl(int frame) {
  UsblSample sample;
  sample.frame = frame % 2 == 0 ? UsblFrame::ned : UsblFrame::vessel_frd;
  sample.transponder = "M17";
  sample.relative_m = {40.0 + frame, -3.0, 25.0};
  sample.sigma_m = 1.4;
  sample.travel_time_s = 0.0337;
  return sample;
}

HeadingSample by_antennas(int frame) {
  HeadingSample sample;
  sample.heading_rad = 0.3 * frame;
  sample.sigma_rad = 0.01;
  return sample;
}

void nmea_frames(ByteVector& stream, int frame) {
  HeadingSample heading;
  heading.heading_rad = 0.7 * frame;
  heading.north = frame % 2 == 0 ? North::true_north : North::magnetic;
  PropulsionSample shaft;
  shaft.rpm = 900.0 - 300.0 * frame;
  FinsSample fins;
  fins.rudder_rad = 0.02 * frame;
  fins.stern_rad = -0.03 * frame;
  append(stream, sim::encode::nmea_gps(gps(frame), instant(frame)));
  append(stream, sim::encode::nmea_heading(heading));
  append(stream, sim::encode::nmea_rpm(shaft));
  append(stream, sim::encode::nmea_fins(fins));
  append(stream, sim::encode::nmea_sentence("SDDPT,2.4,0.5"));
  append(stream, sim::encode::nmea_sentence("PRVAT,02.400,M,0015.250,dBar"));
}

ImuSample imu(int frame) {
  ImuSample sample;
  sample.angular_rate_B_rad_s = {0.001 * frame, -0.002, 0.01};
  sample.specific_force_B_m_s2 = {0.1, -0.05, -9.81};
  if (frame % 2 == 1) {
    sample.delta_angle_B_rad = {1e-5, -2e-5, 1e-4};
    sample.delta_velocity_B_m_s = {1e-3, -5e-4, -0.0981};
    sample.delta_time_s = 0.01;
    sample.temperature_degC = 21.5;
  }
  return sample;
}

/// What an inertial unit says of time: its own clock, now and then UTC besides.
DurationNs since_power_on(int frame) {
  return (frame + 1) * kNsPerSecond / 100;
}

void evologics_lines(ByteVector& stream, int frame) {
  UsblSample fix = usbl(frame);
  fix.frame = frame % 2 == 0 ? UsblFrame::ned : UsblFrame::vehicle_frd;
  fix.transponder = "3";
  const DurationNs measured = since_power_on(frame);
  const std::string line = sim::encode::evologics(fix, measured, measured + 260 * kNsPerMillisecond);
  // As a modem sends it that is not set to count its characters.
  append(stream, frame % 3 == 2 ? line.substr(line.find("USBLLONG")) : line);
  append(stream, sim::encode::evologics_line("RECVIM,4,3,1,ack,280000,-36,77,0.0,0.1\r\n\x01\xFF"));
  append(stream, "+++AT*SENDIM:2:OK\r\n");
}
std::optional<TimeNs> some_utc(int frame) {
  return frame % 4 == 3 ? std::optional<TimeNs>(instant(frame)) : std::nullopt;
}

/// Inertial data, fixes, of which the frames repeat each, and both in one frame.
void vectornav_frames(ByteVector& stream, int frame) {
  const sim::encode::VectornavFix fix{gps(frame / 2), instant(frame / 2)};
  append(stream, sim::encode::vectornav(imu(frame), since_power_on(frame), some_utc(frame)));
  if (frame % 4 == 2)
    append(stream, sim::encode::vectornav(imu(frame), since_power_on(frame), some_utc(frame), &fix));
  append(stream, sim::encode::vectornav_fix(fix));
}

/// Inertial data, fixes, and in one message both.
void xsens_messages(ByteVector& stream, int frame) {
  const ByteVector inertial = sim::encode::xsens(imu(frame), static_cast<std::uint16_t>(65'533 + frame),
                                                 since_power_on(frame), some_utc(frame));
  const ByteVector fix = sim::encode::xsens_fix(gps(frame), instant(frame));
  append(stream, frame % 3 == 2 ? sim::encode::xsens_together(inertial, fix) : inertial);
  if (frame % 3 == 0) append(stream, fix);
  append(stream, sim::encode::xsens_message(0x42, {0x28}));                 // an error code
  append(stream, sim::encode::xsens_message(0x0D, ByteVector(300, 0x03)));  // of extended length
}

/// Of two antennas, once without a solution.
HeadingSample heading_of_antennas(int frame) {
  HeadingSample sample;
  if (frame == 3) return sample;
  sample.heading_rad = 6.0 + 0.01 * frame;
  sample.sigma_rad = frame == 5 ? kUnknown : 0.004;
  return sample;
}

/// Velocity before position, then after it, now and then none; a heading; and what the second receiver says.
void sbg_fixes(ByteVector& stream, int frame, DurationNs clock_ns) {
  const auto velocity = sim::encode::sbg_gps_velocity(gps(frame), instant(frame), clock_ns);
  if (frame % 2 == 0) append(stream, velocity);
  append(stream, sim::encode::sbg_gps_position(gps(frame), instant(frame), clock_ns));
  if (frame % 4 == 1) append(stream, velocity);
  const HeadingSample heading = heading_of_antennas(frame);
  append(stream, sim::encode::sbg_gps_heading(heading, instant(frame), clock_ns));
  if (frame % 3 != 2) return;
  append(stream, sim::encode::sbg_gps_heading(heading, instant(frame), clock_ns, 2));
  append(stream, sim::encode::sbg_gps_velocity(gps(frame), instant(frame), clock_ns, 2));
  append(stream, sim::encode::sbg_gps_position(gps(frame), instant(frame), clock_ns, 2));
}

/// IMU_SHORT, across the return of the clock's bits to 0, and later IMU_DATA.
void sbg_logs(ByteVector& stream, int frame) {
  const bool later = frame >= kFrames / 2;
  const DurationNs clock_ns = 4'294'927'296'000 + since_power_on(frame) + (later ? 2 * kNsPerSecond : 0);
  if (const auto utc = some_utc(frame)) append(stream, sim::encode::sbg_utc_time(*utc, clock_ns));
  append(stream, later ? sim::encode::sbg_imu_data(imu(frame), clock_ns)
                       : sim::encode::sbg_imu_short(imu(frame), clock_ns));
  sbg_fixes(stream, frame, clock_ns);
  append(stream, sim::encode::sbg_frame(6, 0, ByteVector(40, static_cast<std::uint8_t>(frame))));
  append(stream, sim::encode::sbg_frame(4, 0x90, {0x5A, 0xFF}));
}

/// Covariances after the fix, one of them, and before it; a heading; and blocks without sample.
void sbf_blocks(ByteVector& stream, int frame) {
  const TimeNs utc_ns = instant(frame);
  if (frame % 4 == 0) append(stream, sim::encode::sbf_receiver_time(utc_ns, 18));
  if (frame % 4 == 1) {  // RFStatus, one band
    const ByteVector band{1, 8, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0};
    append(stream, sim::encode::sbf_block(4092, 0, utc_ns, band));
  }
  if (frame % 3 == 2) append(stream, sim::encode::sbf_position_covariance(gps(frame), utc_ns));
  append(stream, frame % 3 == 0 ? sim::encode::sbf_epoch(gps(frame), utc_ns)
                                : sim::encode::sbf_pvt_geodetic(gps(frame), utc_ns));
  if (frame % 3 == 1) append(stream, sim::encode::sbf_velocity_covariance(gps(frame), utc_ns));
  append(stream, sim::encode::sbf_attitude_epoch(heading_of_antennas(frame), utc_ns));
  append(stream, sim::encode::sbf_block(4027, 1, utc_ns, ByteVector(20, static_cast<std::uint8_t>(frame))));
}

/// Rates at 10 g, then increments at 5 g, as the configuration between them says.
void stim300_datagrams(ByteVector& stream, int frame) {
  sim::encode::Stim300Frame datagram;
  datagram.counter = static_cast<std::uint8_t>(250 + frame);
  datagram.latency_us = static_cast<std::uint16_t>(500 + frame);
  datagram.line = frame % 3 == 2;
  if (frame >= kFrames / 2) datagram.options = {5.0, 125.0};
  if (frame == kFrames / 2) append(stream, sim::encode::stim300_configuration(datagram.options, 0));
  ImuSample sample = imu(frame);
  if (frame >= kFrames / 2) sample = imu(1);
  append(stream, sim::encode::stim300(sample, datagram));
}

/// What a MicroStrain unit may send without a rate or a force: overrange, event, GPS timestamp, delta of
/// time.
ByteVector other_sensor_data() {
  ByteVector fields{0x04, 0x18, 0x00, 0x11, 0x03, 0xD0, 0x00, 0x0E, 0x12};
  append(fields, ByteVector(11, 0x00));
  fields.push_back(0x1F);
  append(fields, ByteVector{0x0A, 0xD4, 0x3F, 0x84, 0x7A, 0xE1, 0x47, 0xAE, 0x14, 0x7B});
  return sim::encode::microstrain_packet(0x80, fields);
}

AirspeedSample air(int frame) {
  AirspeedSample sample;
  sample.airspeed_m_s = 45.0 + frame;
  sample.true_airspeed_m_s = 49.0 + frame;
  sample.baro_altitude_m = 900.0 + 10.0 * frame;
  return sample;
}

/// The true airspeed first: the codec follows the best quantity that it has heard.
void air_data_sentences(ByteVector& stream, int frame) {
  append(stream, sim::encode::nmea_sentence("WIMWV,2.0,R,9" + std::to_string(frame) + ".4,N,A"));
  append(stream, sim::encode::nmea_air_data(air(frame), {}));
  append(stream,
         sim::encode::nmea_sentence("POV,P,951.78,T,12.5,Q,1" + std::to_string(frame) + "00.5,E,2.15"));
  append(stream, sim::encode::nmea_sentence("IIVWR,2.0,L,97.2,N,50.0,M,180.0,K"));
  append(stream, sim::encode::nmea_sentence("IIXDR,G,100.0,N,TAS"));
}

void telemetry(ByteVector& stream, int frame) {
  const mavlink::Sender autopilot{1, 1};
  const auto put = [&](const auto& message) {
    append(stream, mavlink::frame_of(message, autopilot, static_cast<std::uint8_t>(frame)));
  };
  mavlink::Attitude attitude;
  attitude.time_boot_ms = 1000U + 250U * static_cast<std::uint32_t>(frame);
  attitude.yaw = 0.5F * static_cast<float>(frame) - 1.5F;
  put(attitude);
  put(mavlink::Heartbeat{});
  mavlink::GpsRawInt fix;
  fix.time_usec = 1000ULL * attitude.time_boot_ms;
  fix.fix_type = 3;
  fix.lat = 364'000'000 + frame;
  fix.vel = 125;
  fix.h_acc = 900;
  put(fix);
  mavlink::ScaledPressure2 pressure;
  pressure.time_boot_ms = attitude.time_boot_ms;
  pressure.press_abs = 1100.0F + static_cast<float>(frame);
  put(pressure);
}

void append_frame(ByteVector& stream, std::string_view protocol, int frame) {
  DepthSample depth;
  depth.depth_m = 12.5 + frame;
  if (frame % 2 == 1) depth.temperature_degC = 8.25;
  if (protocol == "nmea0183") {
    nmea_frames(stream, frame);
  } else if (protocol == "psimssb") {
    append(stream, sim::encode::psimssb(usbl(frame), instant(frame)));
  } else if (protocol == "psonlld") {
    UsblSample fix = usbl(frame);
    fix.frame = frame == 2 ? UsblFrame::ned : UsblFrame::geodetic;  // not told, as by a beacon out of earshot
    append(stream, sim::encode::psonlld(fix, instant(frame)));
  } else if (protocol == "evologics") {
    evologics_lines(stream, frame);
  } else if (protocol == "ubx") {
    append(stream, sim::encode::ubx_nav_pvt(gps(frame), instant(frame)));
    append(stream, sim::encode::ubx_nav_relposned(by_antennas(frame), instant(frame)));
    append(stream, sim::encode::ubx_frame(0x01, 0x35, ByteVector(20, static_cast<std::uint8_t>(frame))));
    append(stream, sim::encode::ubx_frame(0x0A, 0x38, ByteVector(4 + 24, 1)));  // MON-RF, one block
  } else if (protocol == "novatel") {
    append(stream, novatel_logs(gps(frame), heading_of_antennas(frame), instant(frame), frame));
  } else if (protocol == "sbf") {
    sbf_blocks(stream, frame);
  } else if (protocol == "paroscientific") {
    append(stream, sim::encode::paroscientific(depth, seed_options(protocol)));
  } else if (protocol == "ascii_depth") {
    append(stream, sim::encode::ascii_depth(depth, seed_options(protocol)));
  } else if (protocol == "pd0") {
    sim::encode::Pd0Options options;
    options.ensemble = static_cast<std::uint32_t>(frame + 1);
    options.high_resolution = frame % 2 == 0;
    append(stream, sim::encode::pd0(dvl(frame), instant(frame), options));
  } else if (protocol == "pd6") {
    pd6_lines(stream, frame);
  } else if (protocol == "waterlinked") {
    append(stream, sim::encode::waterlinked(
                       dvl(frame), {instant(frame), instant(frame) + 190 * kNsPerMillisecond, 250.0}));
  } else if (protocol == "nortek") {
    DvlSample track = dvl(frame);
    if (frame % 3 == 2) track.mode = DvlMode::water;
    track.beam_velocity_m_s = {0.5, 0.4, -0.5, kUnknown};
    append(stream, sim::encode::nortek(track, {instant(frame), instant(frame) + 190 * kNsPerMillisecond}));
    append(stream, sim::encode::nortek_record(0x16, ByteVector(77, 0xA5), frame % 2 == 0));  // currents
  } else if (protocol == "vectornav") {
    vectornav_frames(stream, frame);
  } else if (protocol == "xsens") {
    xsens_messages(stream, frame);
  } else if (protocol == "sbg") {
    sbg_logs(stream, frame);
  } else if (protocol == "stim300") {
    stim300_datagrams(stream, frame);
  } else if (protocol == "kvh") {
    append(stream, kvh_messages(imu(frame), frame));
  } else if (protocol == "microstrain") {
    append(stream, sim::encode::microstrain(imu(frame), since_power_on(frame), some_utc(frame)));
    append(stream, sim::encode::microstrain_gnss(gps(frame), instant(frame), frame % 3 == 0 ? 0x81 : 0x91));
    if (frame % 3 == 2) append(stream, sim::encode::microstrain_gnss(gps(frame), instant(frame), 0x92));
    append(stream, sim::encode::microstrain_packet(0x82, {0x04, 0x10, 0x00, 0x01}));  // of the unit's filter
    if (frame > 4) append(stream, other_sensor_data());
  } else if (protocol == "ascii_air_data") {
    append(stream, sim::encode::ascii_air_data(air(frame), seed_options(protocol)));
  } else if (protocol == "nmea_air_data") {
    air_data_sentences(stream, frame);
  } else if (protocol == "nmea_attitude") {
    append(stream, attitude_sentences(heading_of_antennas(frame), instant(frame), frame));
  } else if (protocol == "ping" || protocol == "ascii_altitude") {
    AltimeterSample bottom;
    if (frame % 4 != 3) bottom.altitude_m = 2.5 + frame;
    if (protocol != "ping") return append(stream, sim::encode::ascii_altitude(bottom));
    append(stream, sim::encode::ping_profile(bottom, static_cast<std::uint32_t>(frame)));
  } else if (protocol == "micromodem") {
    append(stream, sim::encode::nmea_sentence("CAMPR,1" + std::to_string(frame % 3) + ",1,0.2500"));
    append(stream, sim::encode::nmea_sentence("SNTTA,0.1,,0.3," + std::to_string(frame) + ".5,120000.00"));
    append(stream, sim::encode::nmea_sentence("CAREV,120000,AUV,0.93.0.30"));
  } else if (protocol == "gpsd") {
    append(stream, gpsd_reports(instant(frame), frame));
  } else if (protocol == "mavlink") {
    telemetry(stream, frame);
  } else if (protocol == "fix_text") {
    const std::string second = std::to_string(10 + frame % 50);
    append(stream, sim::encode::nmea_sentence("PFTHX,2026-01-31T12:00:" + second + "Z,36.4009,127.4,20"));
    append(stream,
           sim::encode::nmea_sentence("PFTHX,,-36.4,-127.25,3.5,12." + std::to_string(frame % 10) + ",1"));
  } else {
    throw std::invalid_argument(
        "tests/support/codec/seed_streams.cpp: append_frame: no seed stream for protocol " +
        std::string(protocol));
  }
}

}  // namespace

codec::CodecOptions seed_options(std::string_view protocol) {
  codec::CodecOptions options;
  options.latitude_rad = 0.635;
  if (protocol == "ascii_depth") {
    options.ascii_prefix = "D=";
    options.value_is_depth = true;
  }
  return options;
}

ByteVector seed_stream(std::string_view protocol) {
  ByteVector stream;
  for (int frame = 0; frame < kFrames; ++frame) append_frame(stream, protocol, frame);
  return stream;
}

ByteVector mutated(const ByteVector& stream, std::size_t errors, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  ByteVector bytes = stream;
  for (std::size_t i = 0; i < errors && !bytes.empty(); ++i) {
    const auto at = static_cast<std::ptrdiff_t>(random() % bytes.size());
    const auto room = static_cast<std::ptrdiff_t>(bytes.size()) - at;
    const std::ptrdiff_t length =
        std::min<std::ptrdiff_t>(1 + static_cast<std::ptrdiff_t>(random() % 16), room);
    switch (random() % 7) {
      case 0:
      case 1:
        bytes[static_cast<std::size_t>(at)] ^= static_cast<std::uint8_t>(1U << (random() % 8));
        break;
      case 2:
        bytes[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(random());
        break;
      case 3:
        bytes.erase(bytes.begin() + at, bytes.begin() + at + length);
        break;
      case 4: {
        const ByteVector piece = noise(static_cast<std::size_t>(length), random());
        bytes.insert(bytes.begin() + at, piece.begin(), piece.end());
        break;
      }
      case 5: {
        const ByteVector piece(bytes.begin() + at, bytes.begin() + at + length);
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(random() % bytes.size()), piece.begin(),
                     piece.end());
        break;
      }
      default:
        if (i + 1 == errors) bytes.resize(static_cast<std::size_t>(at));
        break;
    }
  }
  return bytes;
}

ByteVector noise(std::size_t length, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  ByteVector bytes(length);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

}  // namespace fathom::test
