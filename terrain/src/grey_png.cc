// SPDX-License-Identifier: Apache-2.0
#include "grey_png.h"

#include <png.h>

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

namespace gaitd::terrain {
namespace {

constexpr int kBits = 16;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

// libpng comes back by longjmp, past destructors: nothing that has one may be made after setjmp.
struct Failure {
  std::jmp_buf back;
  char what[200] = "";
};

[[noreturn]] void fail(png_structp png, png_const_charp what) {
  auto* failure = static_cast<Failure*>(png_get_error_ptr(png));
  std::snprintf(failure->what, sizeof(failure->what), "%s", what);
  std::longjmp(failure->back, 1);
}

void ignore(png_structp /*png*/, png_const_charp /*what*/) {}

struct Reader {
  explicit Reader(Failure* failure)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, failure, fail, ignore)),
        info(png != nullptr ? png_create_info_struct(png) : nullptr) {}
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  png_structp png;
  png_infop info;
};

struct Writer {
  explicit Writer(Failure* failure)
      : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, failure, fail, ignore)),
        info(png != nullptr ? png_create_info_struct(png) : nullptr) {}
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  png_structp png;
  png_infop info;
};

// "" or why an image of that size is none.
std::string wrong_size(std::uint64_t width, std::uint64_t height) {
  if (width >= 2 && height >= 2 && width * height <= kMaxPixels) return "";
  return "expected at least 2 pixels either way and at most " + std::to_string(kMaxPixels) +
         " of them, got " + std::to_string(width) + " x " + std::to_string(height);
}

bool read_header(Reader* reader, Failure* failure, std::FILE* file) {
  if (setjmp(failure->back) != 0) return false;
  png_init_io(reader->png, file);
  png_read_info(reader->png, reader->info);
  return true;
}

bool read_pixels(Reader* reader, Failure* failure, png_bytepp rows) {
  if (setjmp(failure->back) != 0) return false;
  png_set_swap(reader->png);  // PNG is big-endian
  png_set_interlace_handling(reader->png);
  png_read_update_info(reader->png, reader->info);
  png_read_image(reader->png, rows);
  png_read_end(reader->png, nullptr);
  return true;
}

bool write_all(Writer* writer, Failure* failure, std::FILE* file, const GreyImage& image,
               png_bytepp rows) {
  if (setjmp(failure->back) != 0) return false;
  png_init_io(writer->png, file);
  png_set_IHDR(writer->png, writer->info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), kBits, PNG_COLOR_TYPE_GRAY,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer->png, writer->info);
  png_set_swap(writer->png);
  png_write_image(writer->png, rows);
  png_write_end(writer->png, nullptr);
  return true;
}

std::vector<png_bytep> rows_of(std::vector<std::uint16_t>* pixels, int width, int height) {
  std::vector<png_bytep> rows;
  rows.reserve(static_cast<std::size_t>(height));
  for (int row = 0; row < height; ++row) {
    rows.push_back(reinterpret_cast<png_bytep>(pixels->data() + std::size_t{1} * row * width));
  }
  return rows;
}

}  // namespace

std::string read_grey_png(const std::string& name, GreyImage* image) {
  // A pipe would let everybody wait.
  std::error_code ignored;
  const auto status = std::filesystem::status(name, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return "expected a PNG image, got something that is no file";
  }
  const File file(std::fopen(name.c_str(), "rb"));
  if (!file) return std::string("expected a PNG image, got ") + std::strerror(errno);
  Failure failure;
  Reader reader(&failure);
  if (reader.info == nullptr) return "libpng has no memory";
  const auto broken = [&] {
    return std::string("expected a PNG image, got one that libpng refuses: ") + failure.what;
  };
  if (!read_header(&reader, &failure, file.get())) return broken();
  const png_uint_32 width = png_get_image_width(reader.png, reader.info);
  const png_uint_32 height = png_get_image_height(reader.png, reader.info);
  const int bits = png_get_bit_depth(reader.png, reader.info);
  const int channels = png_get_channels(reader.png, reader.info);
  if (bits != kBits || png_get_color_type(reader.png, reader.info) != PNG_COLOR_TYPE_GRAY) {
    return "expected one channel of grey with 16 bit, got " + std::to_string(channels) +
           (channels == 1 ? " channel of " : " channels of ") + std::to_string(bits) + " bit";
  }
  if (std::string problem = wrong_size(width, height); !problem.empty()) return problem;
  image->width = static_cast<int>(width);
  image->height = static_cast<int>(height);
  image->pixels.assign(std::size_t{1} * width * height, 0);
  std::vector<png_bytep> rows = rows_of(&image->pixels, image->width, image->height);
  return read_pixels(&reader, &failure, rows.data()) ? "" : broken();
}

std::string write_grey_png(const GreyImage& image, const std::string& name) {
  if (std::string problem = wrong_size(static_cast<std::uint64_t>(image.width),
                                       static_cast<std::uint64_t>(image.height));
      !problem.empty()) {
    return problem;
  }
  const File file(std::fopen(name.c_str(), "wb"));
  if (!file) return std::string("cannot be written: ") + std::strerror(errno);
  Failure failure;
  Writer writer(&failure);
  if (writer.info == nullptr) return "libpng has no memory";
  std::vector<std::uint16_t> pixels = image.pixels;
  std::vector<png_bytep> rows = rows_of(&pixels, image.width, image.height);
  if (!write_all(&writer, &failure, file.get(), image, rows.data())) {
    return std::string("cannot be written: ") + failure.what;
  }
  return std::fflush(file.get()) == 0 ? ""
                                      : std::string("cannot be written: ") + std::strerror(errno);
}

}  // namespace gaitd::terrain
