#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/result.hpp"

namespace fathom::record {

/// A file of ../idl as it was when this was built.
struct IdlFile {
  std::string_view name;  ///< e.g. "sensors.idl"
  std::string_view text;
};
/// All of them; a file comes after those that it includes.
[[nodiscard]] std::span<const IdlFile> idl_files();

/// The definition of `type` ("fathom::v1::ImuSample") and of every type that it is made of, comments
/// included, as IDL that needs no other file: the schema `omgidl` of an MCAP channel. The files define
/// everything in the module fathom::v1. The error names what is not defined.
[[nodiscard]] Result<std::string> self_contained_idl(std::span<const IdlFile> files, std::string_view type);

}  // namespace fathom::record
