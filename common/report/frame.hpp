#pragma once

#include <string>

/// The frame of a page that needs nothing from elsewhere: by day, by night and on paper.
namespace fathom::report {

/// Up to and with the title as headline.
[[nodiscard]] std::string page_begin(const std::string& title);
[[nodiscard]] std::string page_end();

/// A card. `content` is HTML. Lists of class "findings" have items of class bad, caution or good that begin
/// with a bold word.
[[nodiscard]] std::string section(const std::string& id, const std::string& title,
                                  const std::string& content);

}  // namespace fathom::report
