#include "config/doors/nmea_out_config.hpp"
#include "host/run.hpp"
#include "nmea_out/nmea_out_service.hpp"

int main(int argc, char** argv) {
  using namespace fathom;
  return host::run<config::NmeaOutConfig>(
      argc, argv,
      {"nmea_out", "Tells chart plotters, autopilots and loggers the navigation state as NMEA 0183.", true},
      [](host::ServiceHost& host, const config::NmeaOutConfig& config) {
        nmea_out::NmeaOutService service(host, config);
        return host.run();
      });
}
