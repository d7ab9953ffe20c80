#pragma once

#include <string>

#include "report/material.hpp"

/// The plots of the page, each as SVG.
namespace fathom::report {

[[nodiscard]] std::string track_plot(const Material& material);
[[nodiscard]] std::string error_plots(const Material& material);
[[nodiscard]] std::string nees_plot(const Material& material);
[[nodiscard]] std::string sigma_plots(const Material& material);
[[nodiscard]] std::string innovation_plots(const Material& material);
[[nodiscard]] std::string forecast_plot(const Material& material);
[[nodiscard]] std::string alignment_plot(const Material& material);

}  // namespace fathom::report
