// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace rpc::io
{

using Rgb = std::array<unsigned char, 3>;

inline void append_number(std::string &bytes, const std::uint32_t number)
{
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 255u);
}

/// The check sum of PNG's chunks.
inline std::uint32_t crc_of(const std::string &bytes)
{
  std::uint32_t crc = 0xffffffffu;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1u) != 0 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
  }
  return ~crc;
}

inline void append_chunk(std::string &png, const std::string &kind, const std::string &data)
{
  append_number(png, static_cast<std::uint32_t>(data.size()));
  png += kind + data;
  append_number(png, crc_of(kind + data));
}

/// zlib's format without compression.
inline std::string stored(const std::string &data)
{
  constexpr std::size_t longest = 65535;
  std::string bytes = "\x78\x01";
  for (std::size_t at = 0; at < data.size(); at += longest) {
    const std::size_t size = std::min(longest, data.size() - at);
    bytes += at + size == data.size() ? '\1' : '\0';
    for (const std::size_t number : {size, ~size})
      for (const int shift : {0, 8}) bytes += static_cast<char>(number >> shift & 255u);
    bytes.append(data, at, size);
  }
  std::uint32_t a = 1, b = 0;
  for (const char c : data) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  append_number(bytes, b << 16 | a);
  return bytes;
}

/// A PNG file's bytes.
/// @param pixel    (height, width) places in the palette, from above
/// @param palette  at most 256 colours
inline std::string png_of(const std::vector<unsigned char> &pixel, const int width, const int height,
                          const std::vector<Rgb> &palette)
{
  std::string png = "\x89PNG\r\n\x1a\n", header, colours, rows;
  append_number(header, static_cast<std::uint32_t>(width));
  append_number(header, static_cast<std::uint32_t>(height));
  header += {8, 3, 0, 0, 0}; // bits of a pixel, a palette; its usual compression, filters and order of rows
  for (const Rgb &colour : palette) colours.append(colour.begin(), colour.end());
  for (int y = 0; y < height; ++y) {
    rows += '\0'; // no filter
    rows.append(pixel.begin() + std::ptrdiff_t(width) * y, pixel.begin() + std::ptrdiff_t(width) * (y + 1));
  }
  append_chunk(png, "IHDR", header);
  append_chunk(png, "PLTE", colours);
  append_chunk(png, "IDAT", stored(rows));
  append_chunk(png, "IEND", "");
  return png;
}

} // namespace rpc::io
