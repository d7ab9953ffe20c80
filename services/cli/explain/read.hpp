#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "explain/history.hpp"
#include "record/reader.hpp"

namespace fathom::cli {

/// The topics that explaining reads. The truth of a simulator is not among them.
[[nodiscard]] std::vector<std::string> explained_topics();

/// Adds a message; false where it is none of its topic.
bool add_message(explain::History& history, std::string_view topic, std::span<const std::uint8_t> data,
                 const explain::Arrival& arrival);

/// Adds what a recording holds of a selection; its topics are set here. Returns what could not be read.
[[nodiscard]] std::vector<std::string> read_into(explain::History& history, record::Reader& reader,
                                                 record::Selection selection);

}  // namespace fathom::cli
