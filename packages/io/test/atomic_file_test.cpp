// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/atomic_file.hpp"

#include "rpc/core/error.hpp"
#include "scratch.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace atomic_file_test
{
namespace
{

using rpc::ExitCode;
using rpc::io::AtomicFile;
using rpc::io::remove_older;
using rpc::io::require_replaceable;
using rpc::io::require_writable_folder;
using rpc::io::write_text;
using rpc::test::expect_error;
using rpc::test::FileSizeLimit;
using rpc::test::text_of;

class AtomicFileTest : public testing::Test
{
protected:
  rpc::RCP<const rpc::Comm> comm_ = Tpetra::getDefaultComm();
  rpc::test::Scratch scratch_{*comm_};
};

TEST_F(AtomicFileTest, TextIsWrittenWholeAndLeavesNothingElse)
{
  const std::string text(1 << 20, 'a');
  write_text(scratch_.path("a.txt"), text);
  EXPECT_EQ(text_of(scratch_.path("a.txt")), text);
  write_text(scratch_.path("a.txt"), "new");
  EXPECT_EQ(text_of(scratch_.path("a.txt")), "new");
  EXPECT_EQ(scratch_.num_files(), 1);
}

TEST_F(AtomicFileTest, NothingAppearsWithoutCommit)
{
  {
    const AtomicFile file(scratch_.path("a.txt"));
    EXPECT_NE(file.temporary().find(std::to_string(::getpid())), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(file.temporary()));
    EXPECT_FALSE(std::filesystem::exists(scratch_.path("a.txt")));
  }
  EXPECT_EQ(scratch_.num_files(), 0);
}

TEST_F(AtomicFileTest, OnlyOrdinaryFilesOfAnEarlierRunAreRemoved)
{
  remove_older(scratch_.path("missing.txt"));
  write_text(scratch_.path("a.txt"), "old");
  remove_older(scratch_.path("a.txt"));
  EXPECT_EQ(scratch_.num_files(), 0);
  std::filesystem::create_directory(scratch_.path("folder"));
  remove_older(scratch_.path("folder"));
  EXPECT_TRUE(std::filesystem::is_directory(scratch_.path("folder")));
}

TEST_F(AtomicFileTest, FailedWriteKeepsTheOldFile)
{
  write_text(scratch_.path("a.txt"), "old");
  {
    const FileSizeLimit limit(1000);
    expect_error(ExitCode::internal_error, "cannot write \"" + scratch_.path("a.txt") + "\": File too large",
                 [&] { write_text(scratch_.path("a.txt"), std::string(5000, 'a')); });
  }
  EXPECT_EQ(text_of(scratch_.path("a.txt")), "old");
  EXPECT_EQ(scratch_.num_files(), 1);
}

TEST_F(AtomicFileTest, UnusableFolderIsBadInputWithTheRemedy)
{
  scratch_.write("file", "");
  for (const char *name : {"none/a.txt", "file/a.txt"}) {
    expect_error(ExitCode::bad_input, "--output=DIR", [&] { write_text(scratch_.path(name), "text"); });
    expect_error(ExitCode::bad_input, scratch_.path(name), [&] { write_text(scratch_.path(name), "text"); });
  }
  std::filesystem::create_directory(scratch_.path("folder"));
  expect_error(ExitCode::bad_input, "Is a directory", [&] { write_text(scratch_.path("folder"), "text"); });
  EXPECT_EQ(scratch_.num_files(), 2);
}

TEST_F(AtomicFileTest, FileWithoutPermissionToWriteIsNotReplaced)
{
  if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
  const std::string path = scratch_.write("a.txt", "old");
  std::filesystem::permissions(path, std::filesystem::perms::owner_read);
  expect_error(ExitCode::bad_input, {"a.txt\": Permission denied", "--output=DIR"}, [&] { write_text(path, "new"); });
  EXPECT_EQ(text_of(path), "old");
  EXPECT_EQ(scratch_.num_files(), 1);
}

TEST_F(AtomicFileTest, NameTooLongIsRefusedBeforeAnythingIsWritten)
{
  for (const std::size_t length : {250, 256, 5000}) { // too long meanwhile; on its own; for any system
    const std::string path = scratch_.path(std::string(length, 'n'));
    expect_error(ExitCode::bad_input, {"output: cannot create", "File name too long", "shorter name", "--output=DIR"},
                 [&] { require_replaceable(path); });
    expect_error(ExitCode::bad_input, "File name too long", [&] { write_text(path, "text"); });
  }
  require_replaceable(scratch_.path(std::string(200, 'n')));
  EXPECT_EQ(scratch_.num_files(), 0);
}

TEST_F(AtomicFileTest, WhatIsNoOrdinaryFileIsNotReplaced)
{
  const std::string pipe = scratch_.path("pipe"), link = scratch_.path("link");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0666), 0);
  std::filesystem::create_symlink("/dev/null", link);
  for (const auto &[path, kind] : {std::pair{pipe, "a pipe"}, std::pair{link, "a device"}}) {
    expect_error(
        ExitCode::bad_input,
        {"output: cannot replace \"" + path + "\": it is " + kind + ", not a file", "remove it", "--output=DIR"},
        [&] { require_replaceable(path); });
    expect_error(ExitCode::bad_input, kind, [&] { write_text(path, "text"); });
  }
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  EXPECT_TRUE(std::filesystem::is_symlink(link));
}

TEST_F(AtomicFileTest, LinkThatLeadsNowhereIsReplaced)
{
  for (const char *target : {"nothing", "link"}) {
    const std::string link = scratch_.path("link");
    std::filesystem::remove(link);
    std::filesystem::create_symlink(target, link);
    write_text(link, "text");
    EXPECT_EQ(text_of(link), "text");
  }
}

TEST_F(AtomicFileTest, WritableFolderIsMadeWithItsParents)
{
  const std::string folder = scratch_.path("a/b/c");
  require_writable_folder(folder);
  require_writable_folder(folder);
  require_writable_folder(folder + "/");
  require_writable_folder("");
  EXPECT_TRUE(std::filesystem::is_directory(folder));
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST_F(AtomicFileTest, FolderBelowAFileIsRefused)
{
  const std::string file = scratch_.write("file", "");
  expect_error(ExitCode::bad_input, "Not a directory", [&] { require_writable_folder(file + "/folder"); });
  expect_error(ExitCode::bad_input, "--output=DIR", [&] { require_writable_folder(file + "/folder"); });
  expect_error(ExitCode::bad_input, file, [&] { require_writable_folder(file); });
}

TEST_F(AtomicFileTest, FolderWithoutPermissionIsRefused)
{
  if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
  const std::string folder = scratch_.path("locked");
  std::filesystem::create_directory(folder);
  std::filesystem::permissions(folder, std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  expect_error(ExitCode::bad_input, "Permission denied", [&] { require_writable_folder(folder); });
  expect_error(ExitCode::bad_input, "Permission denied", [&] { write_text(folder + "/a.txt", "text"); });
}

} // namespace
} // namespace atomic_file_test
