#include "view/page_server.h"

#include <gtest/gtest.h>

namespace alhazen::impl {
namespace {

TEST(PageServer, SaysWhereItIs) {
  const PageServer server({.token = "secret"}, {});
  EXPECT_GT(server.port(), 0);
  EXPECT_EQ(server.url(), "http://127.0.0.1:" + std::to_string(server.port()) + "/secret/");
}

}  // namespace
}  // namespace alhazen::impl
