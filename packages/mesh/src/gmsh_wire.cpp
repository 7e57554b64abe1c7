#include "gmsh_wire.hpp"

#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace rpc::mesh
{
namespace
{

/// Last of the bytes: without it they are not whole.
constexpr char end_mark[] = "end of gmsh's mesh";

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
      for (const T &value : values) each_part(value, *this);
    }
  }

  std::string bytes;

private:
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
      for (T &value : values) each_part(value, *this);
    }
  }

private:
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

template <class Contents, class Each, std::enable_if_t<std::is_same_v<std::decay_t<Contents>, GmshContents>, int> = 0>
void each_part(Contents &contents, Each &each)
{
  each(contents.complaint);
  each(contents.solid);
  each(contents.groups);
  each(contents.elements);
  each(contents.node_tags);
  each(contents.coords);
  each(contents.ungrouped_nodes);
}

} // namespace

std::string packed(const GmshContents &contents)
{
  Packer pack;
  each_part(contents, pack);
  pack(std::string(end_mark));
  return std::move(pack.bytes);
}

GmshContents unpacked(const std::string &bytes)
{
  Unpacker unpack(bytes);
  GmshContents contents;
  std::string end;
  each_part(contents, unpack);
  unpack(end);
  if (end != end_mark) throw std::runtime_error("its mesh is not whole");
  return contents;
}

} // namespace rpc::mesh
