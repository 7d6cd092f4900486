#include "cli/occlusion/png_file.h"

#include <png.h>

#include <stdexcept>

namespace ist::test {

cli::Picture decoded(const std::string& png) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, png.data(), png.size()) == 0) {
    throw std::runtime_error(image.message);
  }
  const bool is_rgb = image.format == PNG_FORMAT_RGB;
  image.format = PNG_FORMAT_RGB;
  cli::Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  picture.rgb.resize(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr) == 0 || !is_rgb) {
    throw std::runtime_error(is_rgb ? image.message : "the PNG is not of 8 bits, RGB");
  }
  return picture;
}

answers::Colour pixel_at(const cli::Picture& picture, int x, int y) {
  const std::size_t at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
           static_cast<std::size_t>(x));
  return {picture.rgb.at(at), picture.rgb.at(at + 1), picture.rgb.at(at + 2)};
}

}  // namespace ist::test
