// SPDX-License-Identifier: BSD-3-Clause
#include "gmsh_wire.hpp"

#include <algorithm>
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

class Packer
{
public:
  template <class T>
  void operator()(const T &value)
  {
    static_assert(std::is_arithmetic_v<T>);
    bytes.append(reinterpret_cast<const char *>(&value), sizeof value);
  }
  void operator()(const std::string &text) { array(text); }
  template <class T>
  void operator()(const std::vector<T> &values)
  {
    if constexpr (std::is_arithmetic_v<T>)
      array(values);
    else {
      (*this)(values.size());
      for (const T &value : values) part(value);
    }
  }

  std::string bytes;

private:
  template <class T>
  void part(const T &value)
  {
    if constexpr (std::is_same_v<T, std::string>)
      array(value);
    else
      each_part(value, *this);
  }
  template <class Array>
  void array(const Array &values)
  {
    (*this)(values.size());
    bytes.append(reinterpret_cast<const char *>(values.data()), values.size() * sizeof(typename Array::value_type));
  }
};

class Unpacker
{
public:
  explicit Unpacker(const std::string &bytes) : bytes_(bytes) {}

  template <class T>
  void operator()(T &value)
  {
    static_assert(std::is_arithmetic_v<T>);
    take(&value, sizeof value);
  }
  void operator()(std::string &text) { array(text); }
  template <class T>
  void operator()(std::vector<T> &values)
  {
    if constexpr (std::is_arithmetic_v<T>)
      array(values);
    else {
      values.resize(count(1));
      for (T &value : values) part(value);
    }
  }

private:
  template <class T>
  void part(T &value)
  {
    if constexpr (std::is_same_v<T, std::string>)
      array(value);
    else
      each_part(value, *this);
  }
  /// A number of items of at least `size` bytes each that may still come.
  std::size_t count(const std::size_t size)
  {
    std::size_t items = 0;
    (*this)(items);
    if (items > (bytes_.size() - at_) / size) throw std::runtime_error("its mesh is not whole");
    return items;
  }
  template <class Array>
  void array(Array &values)
  {
    constexpr std::size_t size = sizeof(typename Array::value_type);
    values.resize(count(size));
    take(values.data(), values.size() * size);
  }
  void take(void *const to, const std::size_t size)
  {
    if (size > bytes_.size() - at_) throw std::runtime_error("its mesh is not whole");
    if (size > 0) std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }

  const std::string &bytes_;
  std::size_t at_ = 0;
};

template <class Sizes, class Each, std::enable_if_t<std::is_same_v<std::decay_t<Sizes>, SizeField>, int> = 0>
void each_part(Sizes &sizes, Each &each)
{
  each(sizes.coords);
  each(sizes.simplices);
  each(sizes.size);
  each(sizes.dim);
}

template <class Request, class Each, std::enable_if_t<std::is_same_v<std::decay_t<Request>, GmshRequest>, int> = 0>
void each_part(Request &request, Each &each)
{
  each(request.folder);
  each(request.file);
  each(request.box_dim);
  for (auto *const corner : {&request.lower, &request.upper})
    for (auto &x : *corner) each(x);
  each(request.quadrilaterals);
  each(request.size_factor);
  each(request.size);
  each(request.order);
  each(request.attempt);
  each(request.straight_where_bent);
  each_part(request.sizes, each);
  each(request.dimension_only);
  each(request.geometry);
  each(request.near_tags);
  each(request.near_coords);
}

template <class Group, class Each, std::enable_if_t<std::is_same_v<std::decay_t<Group>, GmshGroup>, int> = 0>
void each_part(Group &group, Each &each)
{
  each(group.dim);
  each(group.tag);
  each(group.name);
}

template <class Elements, class Each, std::enable_if_t<std::is_same_v<std::decay_t<Elements>, GmshElements>, int> = 0>
void each_part(Elements &elements, Each &each)
{
  each(elements.group);
  each(elements.type);
  each(elements.tags);
  each(elements.nodes);
}

template <class Boundary, class Each, std::enable_if_t<std::is_same_v<std::decay_t<Boundary>, GmshBoundary>, int> = 0>
void each_part(Boundary &boundary, Each &each)
{
  auto kind = static_cast<int>(boundary.shape.kind);
  each(kind);
  if constexpr (!std::is_const_v<Boundary>) boundary.shape.kind = static_cast<BoundaryShape::Kind>(kind);
  each(boundary.shape.tag);
  for (auto *const vector : {&boundary.shape.point, &boundary.shape.direction})
    for (auto &x : *vector) each(x);
  each(boundary.shape.radius);
  each(boundary.type);
  each(boundary.nodes);
}

template <class Contents, class Each, std::enable_if_t<std::is_same_v<std::decay_t<Contents>, GmshContents>, int> = 0>
void each_part(Contents &contents, Each &each)
{
  each(contents.complaint);
  each(contents.again);
  each(contents.dim);
  each(contents.groups);
  each(contents.elements);
  each(contents.node_tags);
  each(contents.coords);
  each(contents.boundary);
  each(contents.notes);
}

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
