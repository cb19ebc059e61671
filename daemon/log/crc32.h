// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace gaitd::daemon {

// CRC-32 of IEEE 802.3 (reflected, polynomial 0xEDB88320), as MCAP uses it. To go on with more
// bytes pass the result so far.
std::uint32_t crc32(std::string_view bytes, std::uint32_t so_far = 0);

}  // namespace gaitd::daemon
