#pragma once

// For *_config.cpp of services that read instruments.

#include "config/bridge/instrument_port.hpp"
#include "config/json/schema.hpp"
#include "runtime/byte_source.hpp"
#include "runtime/device_time.hpp"

namespace fathom::config {

void describe(Schema<InstrumentPort>& s);
void describe(Schema<runtime::ByteSourceConfig>& s);
void describe(Schema<runtime::TimeConfig>& s);

}  // namespace fathom::config
