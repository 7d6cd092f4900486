#include "cli/occlusion/png_image.h"

#include <png.h>

#include <stdexcept>

#include "ist/base/assert.h"

namespace ist::cli {

std::string png_of(const Picture& picture) {
  IST_ASSERT(picture.width > 0 && picture.height > 0);
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.rgb.data(), 0, nullptr) ==
      0) {
    throw std::runtime_error(std::string("a picture could not be encoded: ") + image.message);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace ist::cli
