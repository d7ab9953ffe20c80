#pragma once

#include <string>
#include <vector>

#include "config/fusion/fusion_config.hpp"
#include "record/reader.hpp"

namespace fathom::cli {

/// Opens a recording; one that was not closed is said on standard error and read as far as it goes. Throws
/// Failure.
[[nodiscard]] record::Reader open_recording(const std::string& file);

/// The name of the participant that wrote a channel; empty where it is not told.
[[nodiscard]] std::string writer_of(const record::Channel& channel);
/// The part of its writer's identity that is its process'; empty where it is not told.
[[nodiscard]] std::string process_of(const record::Channel& channel);
/// Likewise, of the hexadecimal identity of a writer.
[[nodiscard]] std::string process_of_writer(const std::string& guid);

/// Topics by their full or their short names, e.g. "nav_state". Throws Failure for one that there is not.
[[nodiscard]] std::vector<std::string> topics_of(const std::vector<std::string>& words);

/// Whether the configuration of a service of this name is enclosed in the recording.
[[nodiscard]] bool holds_configuration(const record::Reader& reader, const std::string& service);

/// The configuration that a fusion service of this name ran with, as it is enclosed in the recording, with
/// further overrides behind its own. Of several it is the one of this hash, else the last one. Throws Failure
/// where it is not there, and config::ConfigError.
[[nodiscard]] config::LoadedConfig<config::FusionConfig> recorded_configuration(
    record::Reader& reader, const std::string& file, const std::string& service,
    const std::vector<std::string>& sets = {}, const std::string& hash = {});

}  // namespace fathom::cli
