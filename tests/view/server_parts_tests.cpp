// The parts of the server that need no network.

#include <gtest/gtest.h>

#include "view/page_server.h"
#include "view/server/allowed_hosts.h"
#include "view/server/header_text.h"
#include "view/server/ip_address.h"
#include "view/server/outbox.h"
#include "view/server/request_target.h"
#include "view/server/token.h"

namespace alhazen::impl {
namespace {

OutgoingMessage message_of(size_t size) { return {std::make_shared<const std::string>(size, 'x'), true}; }

TEST(ViewOutbox, WakesTheSenderOnce) {
  Outbox outbox(100);
  EXPECT_TRUE(outbox.push(message_of(10)));
  EXPECT_FALSE(outbox.push(message_of(20)));
  EXPECT_EQ(outbox.bytes(), 30u);
  EXPECT_EQ(outbox.take()->bytes->size(), 10u);
  EXPECT_EQ(outbox.bytes(), 30u) << "what is being sent counts until it is sent";
  EXPECT_FALSE(outbox.push(message_of(5)));
  outbox.sent();
  EXPECT_EQ(outbox.bytes(), 25u);
  EXPECT_EQ(outbox.take()->bytes->size(), 20u);
  outbox.sent();
  EXPECT_EQ(outbox.take()->bytes->size(), 5u);
  outbox.sent();
  EXPECT_FALSE(outbox.take());
  EXPECT_TRUE(outbox.push(message_of(1)));
}

TEST(ViewOutbox, OverflowsAndThenHoldsNothing) {
  Outbox outbox(100);
  EXPECT_TRUE(outbox.push(message_of(1000))) << "a single one may be larger";
  EXPECT_EQ(outbox.take()->bytes->size(), 1000u);
  EXPECT_FALSE(outbox.push(message_of(60)));
  EXPECT_FALSE(outbox.push(message_of(40)));
  EXPECT_FALSE(outbox.has_overflowed());
  const auto last = message_of(1);
  EXPECT_TRUE(outbox.push(last)) << "the server's thread must end the connection";
  EXPECT_TRUE(outbox.has_overflowed());
  EXPECT_EQ(outbox.bytes(), 1000u);
  EXPECT_EQ(last.bytes.use_count(), 1);
  EXPECT_FALSE(outbox.push(message_of(1)));
  EXPECT_FALSE(outbox.take());
  outbox.close();
  EXPECT_EQ(outbox.bytes(), 0u);
}

TEST(ViewRequestTarget, HasTokenPathAndQuery) {
  const auto target = parse_request_target("/abc/save.exr?x=/1?2");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->token, "abc");
  EXPECT_EQ(target->path, "save.exr");
  EXPECT_EQ(target->query, "x=/1?2");
  const auto page = parse_request_target("/abc/?");
  ASSERT_TRUE(page);
  EXPECT_TRUE(page->has_folder);
  EXPECT_EQ(page->path, "");
  EXPECT_EQ(page->query, "");
  const auto bare = parse_request_target("/abc?q");
  ASSERT_TRUE(bare);
  EXPECT_EQ(bare->token, "abc");
  EXPECT_FALSE(bare->has_folder);
  EXPECT_EQ(parse_request_target("/")->token, "");
  for (const char* text : {"", "abc/", "*", "http://localhost/abc/", "/abc/%2e", "/a b", "/abc\\", "/abc/\n"})
    EXPECT_FALSE(parse_request_target(text)) << text;
}

TEST(ViewAllowedHosts, DependOnWhatIsListenedAt) {
  const AllowedHosts of_network("192.0.2.7", *parse_ip_address("192.0.2.7"));
  EXPECT_TRUE(of_network.allows("192.0.2.7:8080"));
  EXPECT_TRUE(of_network.allows("localhost:1")) << "where ssh forwards it";
  EXPECT_FALSE(of_network.allows("192.0.2.8:8080"));
  const AllowedHosts of_all("0.0.0.0", *parse_ip_address("0.0.0.0"));
  EXPECT_TRUE(of_all.allows("192.0.2.8:8080"));
  EXPECT_TRUE(of_all.allows("[2001:db8::1]:8080"));
  EXPECT_FALSE(of_all.allows("evil.example"));
  const AllowedHosts of_name("studio.example", *parse_ip_address("192.0.2.7"));
  EXPECT_TRUE(of_name.allows("Studio.example:80"));
  EXPECT_FALSE(of_name.allows("evil.example"));
  const AllowedHosts of_ipv6("2001:db8::1", *parse_ip_address("2001:db8::1"));
  EXPECT_TRUE(of_ipv6.allows("[2001:DB8:0::1]"));
  EXPECT_FALSE(of_ipv6.allows("2001:db8::1"));
  EXPECT_FALSE(of_ipv6.allows("[2001:db8::1]x"));
}

TEST(ViewAllowedHosts, OriginIsThatOfThePage) {
  EXPECT_TRUE(is_same_origin("http://localhost:80", "localhost:80"));
  EXPECT_TRUE(is_same_origin("HTTP://LOCALHOST:80", "localhost:80"));
  for (const char* origin : {"", "null", "http://", "https://localhost:80", "http://localhost:8",
                             "http://localhost:800", "http://localhost.80", "localhost:80"})
    EXPECT_FALSE(is_same_origin(origin, "localhost:80")) << origin;
}

TEST(ViewIpAddress, KnowsItsKind) {
  EXPECT_TRUE(parse_ip_address("127.9.9.9")->is_loopback());
  EXPECT_TRUE(parse_ip_address("::1")->is_loopback());
  EXPECT_FALSE(parse_ip_address("128.0.0.1")->is_loopback());
  EXPECT_TRUE(parse_ip_address("::")->is_wildcard());
  EXPECT_TRUE(parse_ip_address("0.0.0.0")->is_wildcard());
  EXPECT_TRUE(parse_ip_address("fe80::1")->is_link_local());
  EXPECT_TRUE(parse_ip_address("169.254.1.1")->is_link_local());
  EXPECT_EQ(parse_ip_address("2001:DB8:0:0::1")->to_string(), "2001:db8::1");
  EXPECT_EQ(parse_ip_address("10.0.0.1")->to_string(), "10.0.0.1");
  for (const char* text : {"", "1", "127.1", "0x7f.0.0.1", "1.2.3.4 ", "::g", "localhost", "fe80::1%lo"})
    EXPECT_FALSE(parse_ip_address(text)) << text;
  EXPECT_FALSE(parse_ip_address(std::string_view("127.0.0.1\0x", 11)));
}

TEST(ViewToken, IsComparedWhole) {
  EXPECT_TRUE(equal_tokens("abc", "abc"));
  EXPECT_TRUE(equal_tokens("", ""));
  for (const char* other : {"", "ab", "abcd", "abd", "Abc", "xbc"}) EXPECT_FALSE(equal_tokens("abc", other)) << other;
  const std::string token = random_token();
  EXPECT_EQ(token.size(), 32u);
  EXPECT_TRUE(is_token(token));
  EXPECT_NE(token, random_token());
  for (const char* text : {"", "a/b", "a b", "a?", "ü", "a.b"}) EXPECT_FALSE(is_token(text)) << text;
}

TEST(ViewPage, RunsItsOwnScriptAlone) {
  const std::string page(page_html());
  EXPECT_EQ(page.rfind("<!doctype html>", 0), 0u);
  const std::string nonce = "0123";
  const std::string html = with_nonce(page, nonce);
  EXPECT_EQ(html.find(nonce_mark), std::string::npos);
  // Each script and style is marked, nothing is loaded from elsewhere, and no attribute has code or styles, which the
  // policy would ignore.
  const auto count = [&](const std::string& text) {
    size_t found = 0;
    for (size_t at = html.find(text); at != std::string::npos; at = html.find(text, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("<script"), 1u);
  EXPECT_EQ(count("<script nonce=\"0123\">"), 1u);
  EXPECT_EQ(count("<style"), 1u);
  EXPECT_EQ(count("<style nonce=\"0123\">"), 1u);
  const std::string body = html.substr(html.find("</style>"), html.find("<script") - html.find("</style>"));
  for (const char* text : {" style=", " onclick=", " onload=", "http://", "https://"})
    EXPECT_EQ(body.find(text), std::string::npos) << text;
}

}  // namespace
}  // namespace alhazen::impl
