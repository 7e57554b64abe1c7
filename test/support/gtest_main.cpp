// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Core.hpp>
#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace
{

/// Says on ranks > 0 only what failed; rank 0 has GoogleTest's own printer.
class FailurePrinter : public testing::EmptyTestEventListener
{
public:
  explicit FailurePrinter(const int rank) : rank_(rank) {}

private:
  void OnTestStart(const testing::TestInfo &test) override { test_ = &test; }
  void OnTestEnd(const testing::TestInfo &) override { test_ = nullptr; }
  void OnTestPartResult(const testing::TestPartResult &result) override
  {
    if (!result.failed()) return;
    std::ostringstream text; // one write, or the lines of several ranks mix
    text << "rank " << rank_ << ": ";
    if (test_) text << test_->test_suite_name() << '.' << test_->name() << ": ";
    text << (result.file_name() ? result.file_name() : "?") << ':' << result.line_number() << ": " << result.message()
         << '\n';
    std::cerr << text.str() << std::flush;
  }

  int rank_;
  const testing::TestInfo *test_ = nullptr;
};

/// Takes each --source=PATH out of the arguments, and makes the tests of source files whose paths end so the only ones.
void choose_source(int &argc, char **argv)
{
  constexpr std::string_view option = "--source=";
  const auto ends = [](const std::string_view text, const std::string_view end) {
    return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
  };
  int kept = 1;
  std::string filter = "none"; // lest an empty one run all
  for (int k = 1; k < argc; ++k) {
    const std::string_view argument = argv[k];
    if (argument.substr(0, option.size()) != option) {
      argv[kept++] = argv[k];
      continue;
    }
    const auto &unit_test = *testing::UnitTest::GetInstance();
    for (int s = 0; s < unit_test.total_test_suite_count(); ++s)
      for (int t = 0; t < unit_test.GetTestSuite(s)->total_test_count(); ++t) {
        const testing::TestInfo &test = *unit_test.GetTestSuite(s)->GetTestInfo(t);
        if (ends(test.file(), argument.substr(option.size())))
          filter += std::string(":") + test.test_suite_name() + "." + test.name();
      }
  }
  if (kept < argc) testing::GTEST_FLAG(filter) = filter;
  argc = kept;
}

/// Runs the chosen tests on every rank; the exit code is 1 on every rank if a test failed on any.
int run_on_all(const Teuchos::Comm<int> &comm)
{
  const int rank = comm.getRank();
  auto &unit_test = *testing::UnitTest::GetInstance();
  if (rank > 0) {
    auto &listeners = unit_test.listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailurePrinter(rank)); // owned by GoogleTest
  } else {
    std::cout << "[   RANKS  ] " << comm.getSize() << ", Kokkos " << Kokkos::DefaultExecutionSpace::name() << std::endl;
  }
  const bool failed_here = RUN_ALL_TESTS() != 0 || unit_test.test_to_run_count() == 0;
  const int mine = failed_here ? 1 : 0;
  int failed_ranks = 0;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, mine, Teuchos::outArg(failed_ranks));
  if (rank == 0 && failed_ranks > 0)
    std::cout << "[  FAILED  ] on " << failed_ranks << " of " << comm.getSize() << " ranks" << std::endl;
  return failed_ranks > 0 ? 1 : 0;
}

/// Trilinos and MPI, begun. AddressSanitizer counts nothing as lost that they allocate meanwhile.
std::unique_ptr<Tpetra::ScopeGuard> begin(int &argc, char **&argv)
{
#ifdef __SANITIZE_ADDRESS__
  const __lsan::ScopedDisabler foreign;
#endif
  return std::make_unique<Tpetra::ScopeGuard>(&argc, &argv);
}

/// Whether memory was lost, where AddressSanitizer watches. MPI still runs: once it has unloaded its plug-ins, what they keep
/// would count as lost, and nothing would tell whose it was.
bool has_leaked()
{
#ifdef __SANITIZE_ADDRESS__
  return __lsan_do_recoverable_leak_check() != 0;
#else
  return false;
#endif
}

} // namespace

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv); // takes its options out of argv before Kokkos sees them
  choose_source(argc, argv);
  const auto scope = begin(argc, argv);
  const int failed = run_on_all(*Tpetra::getDefaultComm());
  return has_leaked() ? 1 : failed;
}
