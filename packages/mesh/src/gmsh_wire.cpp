// SPDX-License-Identifier: BSD-3-Clause
#include "gmsh_wire.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <sys/socket.h>
#include <type_traits>

namespace rpc::mesh
{
namespace
{

/// Last of the bytes: without it they are not whole.
constexpr char end_mark[] = "end of what gmsh is told or tells";

/// First byte of a message.
enum class Kind : char { bytes, end };

constexpr std::size_t longest_piece = 1 << 16; // a fraction of what a socket holds

bool send_message(const int socket, const Kind kind, const void *const data, const std::size_t size)
{
  Kind first = kind;
  iovec parts[2] = {{&first, 1}, {const_cast<void *>(data), size}};
  msghdr message{};
  message.msg_iov = parts;
  message.msg_iovlen = 2;
  for (;;) {
    const ssize_t sent = ::sendmsg(socket, &message, MSG_NOSIGNAL);
    if (sent >= 0) return true;
    if (errno != EINTR) return false;
  }
}

/// What a struct has, one part after the other, to be packed or unpacked.
template <class Sizes, class Each, std::enable_if_t<std::is_same_v<std::decay_t<Sizes>, SizeField>, int> = 0>
void each_part(Sizes &sizes, Each &each)
{
  each(sizes.coords, sizes.simplices, sizes.size, sizes.dim);
}

template <class Request, class Each, std::enable_if_t<std::is_same_v<std::decay_t<Request>, GmshRequest>, int> = 0>
void each_part(Request &r, Each &each)
{
  each(r.folder, r.file, r.box_dim, r.lower, r.upper, r.quadrilaterals, r.simplices, r.size_factor, r.size, r.order,
       r.attempt, r.straight_where_bent, r.sizes, r.dimension_only, r.geometry, r.near_tags, r.near_coords);
}

template <class Group, class Each, std::enable_if_t<std::is_same_v<std::decay_t<Group>, GmshGroup>, int> = 0>
void each_part(Group &group, Each &each)
{
  each(group.dim, group.tag, group.name);
}

template <class Elements, class Each, std::enable_if_t<std::is_same_v<std::decay_t<Elements>, GmshElements>, int> = 0>
void each_part(Elements &elements, Each &each)
{
  each(elements.group, elements.type, elements.tags, elements.nodes);
}

template <class Boundary, class Each, std::enable_if_t<std::is_same_v<std::decay_t<Boundary>, GmshBoundary>, int> = 0>
void each_part(Boundary &boundary, Each &each)
{
  auto &shape = boundary.shape;
  each(shape.kind, shape.tag, shape.point, shape.direction, shape.radius, boundary.type, boundary.nodes);
}

template <class Contents, class Each, std::enable_if_t<std::is_same_v<std::decay_t<Contents>, GmshContents>, int> = 0>
void each_part(Contents &c, Each &each)
{
  each(c.complaint, c.again, c.dim, c.groups, c.elements, c.node_tags, c.coords, c.boundary, c.notes);
}

template <class T>
constexpr bool is_number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

class Packer
{
public:
  template <class... T>
  void operator()(const T &...values)
  {
    (one(values), ...);
  }

  std::string bytes;

private:
  template <class T>
  void one(const T &value)
  {
    if constexpr (is_number<T>)
      append(&value, 1);
    else
      each_part(value, *this);
  }
  void one(const std::string &text)
  {
    one(text.size());
    append(text.data(), text.size());
  }
  template <class T, std::size_t size>
  void one(const std::array<T, size> &values)
  {
    append(values.data(), size);
  }
  template <class T>
  void one(const std::vector<T> &values)
  {
    one(values.size());
    if constexpr (is_number<T>)
      append(values.data(), values.size());
    else
      for (const T &value : values) one(value);
  }
  template <class T>
  void append(const T *const values, const std::size_t count)
  {
    bytes.append(reinterpret_cast<const char *>(values), count * sizeof(T));
  }
};

class Unpacker
{
public:
  explicit Unpacker(const std::string &bytes) : bytes_(bytes) {}

  template <class... T>
  void operator()(T &...values)
  {
    (one(values), ...);
  }

private:
  template <class T>
  void one(T &value)
  {
    if constexpr (is_number<T>)
      take(&value, 1);
    else
      each_part(value, *this);
  }
  void one(std::string &text)
  {
    text.resize(count(1));
    take(text.data(), text.size());
  }
  template <class T, std::size_t size>
  void one(std::array<T, size> &values)
  {
    take(values.data(), size);
  }
  template <class T>
  void one(std::vector<T> &values)
  {
    values.resize(count(is_number<T> ? sizeof(T) : 1));
    if constexpr (is_number<T>)
      take(values.data(), values.size());
    else
      for (T &value : values) one(value);
  }
  /// A number of items of at least `size` bytes each that may still come.
  std::size_t count(const std::size_t size)
  {
    std::size_t items = 0;
    one(items);
    if (items > (bytes_.size() - at_) / size) throw std::runtime_error("its mesh is not whole");
    return items;
  }
  template <class T>
  void take(T *const to, const std::size_t items)
  {
    const std::size_t size = items * sizeof(T);
    if (size > bytes_.size() - at_) throw std::runtime_error("its mesh is not whole");
    if (size > 0) std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }

  const std::string &bytes_;
  std::size_t at_ = 0;
};

template <class T>
std::string all_packed(const T &value)
{
  Packer pack;
  each_part(value, pack);
  pack(std::string(end_mark));
  return std::move(pack.bytes);
}

template <class T>
T all_unpacked(const std::string &bytes)
{
  Unpacker unpack(bytes);
  T value;
  std::string end;
  each_part(value, unpack);
  unpack(end);
  if (end != end_mark) throw std::runtime_error("its mesh is not whole");
  return value;
}

} // namespace

std::string packed(const GmshRequest &request)
{
  return all_packed(request);
}
std::string packed(const GmshContents &contents)
{
  return all_packed(contents);
}

GmshRequest unpacked_request(const std::string &bytes)
{
  return all_unpacked<GmshRequest>(bytes);
}
GmshContents unpacked_contents(const std::string &bytes)
{
  return all_unpacked<GmshContents>(bytes);
}

bool send_bytes(const int socket, const std::string &bytes)
{
  for (std::size_t done = 0; done < bytes.size(); done += longest_piece)
    if (!send_message(socket, Kind::bytes, bytes.data() + done, std::min(longest_piece, bytes.size() - done)))
      return false;
  return true;
}

bool send_end(const int socket, const int number)
{
  return send_message(socket, Kind::end, &number, sizeof number);
}

bool receive(const int socket, std::string &bytes, int &number)
{
  std::string piece(longest_piece, '\0');
  for (;;) {
    Kind first{};
    iovec parts[2] = {{&first, 1}, {piece.data(), piece.size()}};
    msghdr message{};
    message.msg_iov = parts;
    message.msg_iovlen = 2;
    const ssize_t count = ::recvmsg(socket, &message, 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    const std::size_t size = static_cast<std::size_t>(count) - 1;
    if (first == Kind::bytes) {
      bytes.append(piece.data(), size);
    } else {
      if (size != sizeof number) return false;
      std::memcpy(&number, piece.data(), size);
      return true;
    }
  }
}

} // namespace rpc::mesh
