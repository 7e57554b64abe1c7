// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"

#include <string>

namespace rpc::mesh
{

// What passes between two programs of one machine, over a socket that keeps messages apart (SOCK_SEQPACKET): pieces of
// bytes, then an end with a number. A sender that dies leaves whole pieces, and its parent may send the end for it.

/// rpc_gmsh's end of the socket: a file descriptor that nothing else of gmsh reads or writes.
constexpr int gmsh_socket = 3;

std::string packed(const GmshRequest &request);
std::string packed(const GmshContents &contents);

/// @throws std::runtime_error if the bytes are not whole
GmshRequest unpacked_request(const std::string &bytes);
GmshContents unpacked_contents(const std::string &bytes);

/// @return whether the other side is open
bool send_bytes(int socket, const std::string &bytes);
bool send_end(int socket, int number);

/// Waits for the end, and adds the bytes before it. @return whether it came: false if the other side closed
bool receive(int socket, std::string &bytes, int &number);

} // namespace rpc::mesh
