// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/file_reader.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/on_root.hpp"

#include <filesystem>
#include <fstream>
#include <limits>

namespace rpc
{

std::string bytes_of_file(const std::string &name, const std::string &parameter)
{
  namespace fs = std::filesystem;
  const std::string where = "deck: \"" + parameter + "\": ";
  std::error_code error;
  RPC_REQUIRE(fs::exists(name, error), where
                                           << "there is no file \"" << name
                                           << "\". Name one by its path from the deck's folder, or by its whole path");
  RPC_REQUIRE(fs::is_regular_file(name, error), where << "\"" << name << "\" is no file. Name a file");
  const auto size = fs::file_size(name, error);
  constexpr auto most = static_cast<std::uintmax_t>(std::numeric_limits<int>::max()); // of a broadcast
  RPC_REQUIRE(!error && size <= most,
              where << "\"" << name << "\" must hold at most " << most << " bytes, got " << size);
  std::ifstream in(name, std::ios::binary);
  std::string bytes(size, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  RPC_REQUIRE(in && static_cast<std::uintmax_t>(in.gcount()) == size,
              where << "\"" << name << "\" cannot be read. Make it readable for you, or name another one");
  return bytes;
}

FileReader file_reader_of_root(const std::string &folder, const Comm &comm)
{
  return [folder, &comm](const std::string &name, const std::string &parameter) {
    return text_of_root(comm, ExitCode::bad_input, [&] {
      const std::string beside_deck = (std::filesystem::path(folder) / name).string(); // name itself if it is absolute
      std::error_code ignored;
      const bool here = !std::filesystem::exists(beside_deck, ignored) && std::filesystem::exists(name, ignored);
      return bytes_of_file(here ? name : beside_deck, parameter);
    });
  };
}

} // namespace rpc
