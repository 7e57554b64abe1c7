#include "expect_error.hpp"
#include "rpc/mesh/box.hpp"

#include <Teuchos_Array.hpp>
#include <limits>

namespace
{

using rpc::ExitCode;
using rpc::mesh::BoxOptions;
using rpc::test::expect_error;
using Teuchos::Array;
using Teuchos::tuple;

/// The defaults with one parameter changed.
template <class T>
Teuchos::ParameterList deck(const std::string &name, const T &value)
{
  auto list = rpc::mesh::valid_parameters();
  list.set(name, value);
  return list;
}

TEST(BoxOptions, DefaultsAreTheUnitSquare)
{
  const BoxOptions options = rpc::mesh::box_options(rpc::mesh::valid_parameters());
  EXPECT_EQ(options.lower, (std::vector<double>{0, 0}));
  EXPECT_EQ(options.upper, (std::vector<double>{1, 1}));
  EXPECT_EQ(options.cells, (std::vector<int>{8, 8}));
  EXPECT_EQ(options.element.dim, 2);
  EXPECT_EQ(options.element.order, 1);
}

TEST(BoxOptions, ThreeNumbersMakeItThreeDimensional)
{
  auto list = deck("Lower", Array<double>(tuple(0., 0., -1.)));
  list.set("Upper", Array<double>(tuple(1., 2., 3.))).set("Cells", Array<int>(tuple(1, 2, 3)));
  const BoxOptions options = rpc::mesh::box_options(list);
  EXPECT_EQ(options.element.dim, 3);
  EXPECT_EQ(options.element.order, 1);
  EXPECT_EQ(options.upper, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(options.cells, (std::vector<int>{1, 2, 3}));
}

TEST(BoxOptions, BadValuesAreRefusedByName)
{
  const auto refused = [](const Teuchos::ParameterList &list, const std::initializer_list<std::string> parts) {
    expect_error(ExitCode::bad_input, parts, [&] { rpc::mesh::box_options(list); });
  };
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  refused(deck("Type", "sphere"), {"\"Mesh->Type\"", "box", "\"sphere\""});
  refused(deck("Element", "Q3"), {"\"Mesh->Element\"", "\"Q3\""});
  refused(deck("Lower", Array<double>(tuple(0.))), {"\"Mesh->Lower\"", "2 or 3", "got 1"});
  refused(deck("Lower", Array<double>()), {"\"Mesh->Lower\"", "got 0"});
  refused(deck("Upper", Array<double>(tuple(1., 1., 1.))), {"one length", "2, 3 and 2"});
  refused(deck("Cells", Array<int>(tuple(1))), {"one length", "2, 2 and 1"});
  refused(deck("Upper", Array<double>(tuple(1., 0.))), {"\"Mesh->Upper\"", "direction 2"});
  refused(deck("Upper", Array<double>(tuple(-1., 1.))), {"\"Mesh->Upper\"", "direction 1"});
  refused(deck("Upper", Array<double>(tuple(inf, 1.))), {"\"Mesh->Upper\"", "inf"});
  refused(deck("Lower", Array<double>(tuple(nan, 0.))), {"\"Mesh->Upper\"", "nan"});
  refused(deck("Cells", Array<int>(tuple(8, 0))), {"\"Mesh->Cells\"", "got 0", "direction 2"});
  refused(deck("Cells", Array<int>(tuple(-8, 8))), {"\"Mesh->Cells\"", "got -8"});
  refused(deck("Cells", Array<int>(tuple(100000, 100000))), {"\"Mesh->Cells\"", "nodes", "supported"});
}

} // namespace
