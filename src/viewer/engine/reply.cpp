#include "viewer/engine/reply.h"

#include <nlohmann/json.hpp>

namespace ist::viewer {

Reply::Reply()
    : json_(std::make_unique<nlohmann::ordered_json>(nlohmann::ordered_json::object())) {}
Reply::~Reply() = default;
Reply::Reply(Reply&&) noexcept = default;
Reply& Reply::operator=(Reply&&) noexcept = default;

nlohmann::ordered_json Reply::array(const char* kind, const void* address, std::size_t count) {
  return {{"array", {kind, reinterpret_cast<std::uintptr_t>(address), count}}};
}

}  // namespace ist::viewer
