#include <iostream>

#include "base/exit_code.hpp"
#include "config/json/error.hpp"
#include "dataset/dataset.hpp"
#include "demo/options.hpp"
#include "demo/run.hpp"

int main(int argc, char** argv) {
  using fathom::ExitCode;
  const auto parsed = fathom::demo::parse(argc, argv);
  if (parsed.exit) return *parsed.exit;
  try {
    return static_cast<int>(fathom::demo::run(parsed.options));
  } catch (const fathom::config::ConfigError& error) {
    std::cerr << "fathom-demo: " << error.what() << '\n';
    return static_cast<int>(ExitCode::bad_configuration);
  } catch (const fathom::dataset::DatasetError& error) {
    std::cerr << "fathom-demo: " << error.what() << '\n';
    return static_cast<int>(ExitCode::bad_input);
  } catch (const std::exception& error) {
    std::cerr << "fathom-demo: " << error.what() << '\n';
    return static_cast<int>(ExitCode::runtime_failure);
  }
}
