#include "security/keygen.hpp"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/clock.hpp"
#include "cli/command.hpp"
#include "security/inspect.hpp"

namespace fathom::cli {
namespace {

struct Options {
  security::KeygenOptions make;
  std::vector<std::string> services;
  std::string protection = "encrypt";
  bool rotate = false;
  bool check = false;
  bool json = false;
};

std::string day(TimeNs utc) {
  return utc == 0 ? "unknown" : to_iso8601(utc, 0).substr(0, 10);
}

void print_table(const security::Inspection& found) {
  std::printf("vehicle %s, domains %u to %u\n", found.vehicle.c_str(), found.domains.first,
              found.domains.last);
  for (const security::Inspected& item : found.items) {
    std::printf("%s %-16s until %s%s%s\n", item.fault.empty() ? "  ok    " : "PROBLEM ", item.name.c_str(),
                day(item.validity.until_ns).c_str(), item.fault.empty() ? "" : ": ", item.fault.c_str());
  }
  if (found.authority_present) {
    std::puts("  note   the authorities' own keys lie here: fine on a desk, keep them off the vehicle");
  }
}

void print_json(const security::Inspection& found) {
  nlohmann::ordered_json items = nlohmann::ordered_json::array();
  for (const security::Inspected& item : found.items) {
    items.push_back({{"name", item.name},
                     {"until_utc", item.validity.until_ns == 0
                                       ? nlohmann::ordered_json(nullptr)
                                       : nlohmann::ordered_json(to_iso8601(item.validity.until_ns, 0))},
                     {"usable", item.usable},
                     {"fault", item.fault}});
  }
  std::puts(nlohmann::ordered_json{{"good", found.good()},
                                   {"vehicle", found.vehicle},
                                   {"domains", {found.domains.first, found.domains.last}},
                                   {"authority_present", found.authority_present},
                                   {"items", items}}
                .dump()
                .c_str());
}

ExitCode inspect(const Options& options, TimeNs now) {
  const security::Inspection found = security::inspect(options.make.folder, now);
  options.json ? print_json(found) : print_table(found);
  return found.good() ? ExitCode::done : ExitCode::no;
}

ExitCode run(Options& options) {
  const TimeNs now = SystemClock().utc_ns();
  try {
    if (options.check) return inspect(options, now);
    if (options.rotate || !options.services.empty()) {
      security::renew_identities(options.make.folder, options.services, options.make.days, now);
      std::fprintf(stderr, "%s: identities renewed; services use them from their next start\n",
                   options.make.folder.c_str());
      return ExitCode::done;
    }
    if (options.make.domains.first > options.make.domains.last) {
      throw Failure(ExitCode::bad_configuration,
                    "--domains: the first is behind the last, expected FIRST LAST");
    }
    options.make.protection = options.protection == "sign" ? security::MessageProtection::sign
                                                           : security::MessageProtection::encrypt;
    security::make_credentials(options.make, now);
    std::fprintf(stderr, "%s: credentials made; take %s/authority away from the vehicle\n",
                 options.make.folder.c_str(), options.make.folder.c_str());
    return ExitCode::done;
  } catch (const security::WriteError& error) {
    throw Failure(ExitCode::runtime_failure, error.what());
  } catch (const security::SecurityError& error) {
    throw Failure(ExitCode::bad_configuration, error.what());
  }
}

}  // namespace

void add_keygen(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  security::KeygenOptions& make = options->make;
  CLI::App* command = app.add_subcommand(
      "keygen", "Makes, renews and checks the identities and permissions of a vehicle network.");
  command->footer("Exit code: 0 done, 1 with --check: something is wrong or ends within 30 days.");
  command->add_option("folder", make.folder, "Folder of the credentials")->required();
  auto* vehicle =
      command->add_option("--vehicle", make.vehicle, "Name of the vehicle")->capture_default_str();
  auto* domains = command
                      ->add_option_function<std::vector<std::uint32_t>>(
                          "--domains",
                          [&make](const std::vector<std::uint32_t>& range) {
                            make.domains = {range[0], range[1]};
                          },
                          "First and last DDS domain that the credentials are for; default: 0 230")
                      ->expected(2)
                      ->check(CLI::Range(0, 232));
  auto* days = command->add_option("--days", make.days, "Days that identities hold")
                   ->check(CLI::Range(1, 36500))
                   ->capture_default_str();
  auto* ca_days = command->add_option("--ca-days", make.ca_days, "Days that the authorities hold")
                      ->check(CLI::Range(1, 36500))
                      ->capture_default_str();
  auto* messages = command
                       ->add_option("--messages", options->protection,
                                    "Protection of each message around its encrypted samples")
                       ->check(CLI::IsMember({"sign", "encrypt"}))
                       ->capture_default_str();
  auto* force =
      command->add_flag("--force", make.replace, "Make new authorities where there are some already");
  auto* service = command
                      ->add_option("--service", options->services,
                                   "Renew this identity by the authorities in the folder; may be repeated")
                      ->allow_extra_args(false)
                      ->excludes(force);
  auto* rotate =
      command->add_flag("--rotate", options->rotate, "Renew every identity by the authorities in the folder")
          ->excludes(force)
          ->excludes(service);
  auto* check =
      command->add_flag("--check", options->check, "Say what holds until when and whether all fits together")
          ->excludes(force)
          ->excludes(service)
          ->excludes(rotate);
  check->excludes(days);
  for (CLI::Option* other : {service, rotate, check})  // these take what the folder says
    other->excludes(vehicle)->excludes(domains)->excludes(ca_days)->excludes(messages);
  command->add_flag("--json", options->json, "With --check: one line of JSON")->needs(check);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fathom::cli
