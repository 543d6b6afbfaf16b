// The server's answers by HTTP, and where it listens.

#include "view/page_server.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>

#include "util/diagnostics.h"
#include "view/echo_server.h"
#include "view/page_client.h"

namespace alhazen::impl {
namespace {

#ifdef ALHAZEN_WITH_VIEW_SERVER

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string error_of(const PageServerOptions& options) {
  try {
    const PageServer server(options, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PageServer, ServesThePage) {
  const EchoServer server;
  const HttpAnswerText answer = get(server.port(), "/secret/");
  EXPECT_EQ(answer.status, 200);
  EXPECT_TRUE(has(answer.header, "Content-Type: text/html; charset=utf-8\r\n"));
  EXPECT_TRUE(has(answer.header, "Cache-Control: no-store\r\n"));
  EXPECT_TRUE(has(answer.header, "X-Content-Type-Options: nosniff\r\n"));
  EXPECT_TRUE(has(answer.header, "Referrer-Policy: no-referrer\r\n"));
  const size_t nonce_at = answer.header.find("script-src 'nonce-");
  ASSERT_NE(nonce_at, std::string::npos) << answer.header;
  const std::string nonce = answer.header.substr(nonce_at + 18, 32);
  EXPECT_TRUE(has(answer.body, "<script nonce=\"" + nonce + "\">"));
  EXPECT_TRUE(has(answer.body, "<style nonce=\"" + nonce + "\">"));
  EXPECT_TRUE(has(answer.body, "</html>"));
  EXPECT_FALSE(has(answer.body, "<!-- script -->") || has(answer.body, "<!-- style -->"));
  EXPECT_FALSE(has(get(server.port(), "/secret/").body, nonce)) << "a nonce is used once";
}

TEST(PageServer, RedirectsToTheFolderOfThePage) {
  const EchoServer server;
  const HttpAnswerText answer = get(server.port(), "/secret");
  EXPECT_EQ(answer.status, 308);
  EXPECT_TRUE(has(answer.header, "Location: /secret/\r\n")) << answer.header;
}

TEST(PageServer, RefusesWhoDoesNotKnowTheToken) {
  const EchoServer server;
  for (const char* target : {"/", "/wrong/", "/secre/", "/secrets/", "/secreT/", "/wrong/save.exr", "//secret/",
                             "/favicon.ico", "/secret%2f", "/?secret", "http://localhost/secret/", "*", "/secret\\/"})
    EXPECT_EQ(get(server.port(), target).status, 403) << target;
  EXPECT_EQ(ask(server.port(), "POST /wrong/ HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 403);
}

TEST(PageServer, HasARandomTokenUnlessOneIsGiven) {
  const PageServer a({}, {}), b({}, {});
  const std::string token = a.url().substr(a.url().size() - 33, 32);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos) << a.url();
  EXPECT_NE(token, b.url().substr(b.url().size() - 33, 32));
  EXPECT_EQ(get(a.port(), '/' + token + '/').status, 200);
  EXPECT_EQ(get(b.port(), '/' + token + '/').status, 403);
  EXPECT_TRUE(has(error_of({.token = "a/b"}), "token 'a/b': "));
}

TEST(PageServer, AnswersGetAlone) {
  const EchoServer server;
  for (const char* method :
       {"POST", "PUT", "DELETE", "HEAD", "OPTIONS", "PATCH", "TRACE", "CONNECT", "get", "NONSENSE"}) {
    const HttpAnswerText answer =
        ask(server.port(), std::string(method) + " /secret/ HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(answer.status, 405) << method;
    EXPECT_TRUE(has(answer.header, "Allow: GET\r\n")) << method;
  }
  EXPECT_EQ(ask(server.port(), "GET /secret/ HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\n\r\nabc").status, 413);
}

TEST(PageServer, OffersDownloads) {
  const EchoServer server;
  const HttpAnswerText answer = get(server.port(), "/secret/save.exr?exposure=1&x=%20");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, "save.exr?exposure=1&x=%20");
  EXPECT_TRUE(has(answer.header, "Content-Type: image/x-exr\r\n"));
  EXPECT_TRUE(has(answer.header,
                  "Content-Disposition: attachment; filename=\"Kugel ______X-Evil_ 1.exr\"; "
                  "filename*=UTF-8''Kugel%20%22%C3%BC%22%0D%0AX-Evil%3A%201.exr\r\n"))
      << answer.header;
  EXPECT_EQ(get(server.port(), "/secret/large").body.size(), size_t{20} << 20);
}

TEST(PageServer, HasNothingElse) {
  const EchoServer server;
  for (const char* target : {"/secret/x", "/secret/../secret/", "/secret//", "/secret/socket/", "/secret/index.html"})
    EXPECT_EQ(get(server.port(), target).status, 404) << target;
  const PageServer without_events({.token = "secret"}, {});
  EXPECT_EQ(get(without_events.port(), "/secret/save.exr").status, 404);
  EXPECT_EQ(get(server.port(), "/secret/socket").status, 426);
}

TEST(PageServer, AnswersWhereTheProgramThrows) {
  const EchoServer server;
  const HttpAnswerText answer = get(server.port(), "/secret/throws");
  EXPECT_EQ(answer.status, 500);
  EXPECT_EQ(answer.body, "it cannot be done\n");
}

TEST(PageServer, ServesThePageWhileTheProgramTakesItsTime) {
  EchoServer server;
  PageClient slow(server.port());
  slow.send("GET /secret/slow HTTP/1.1\r\nHost: localhost\r\n\r\n");
  ASSERT_TRUE(comes_true([&] { return server.is_slow_one_running.load(); }));
  EXPECT_EQ(get(server.port(), "/secret/").status, 200);
  EXPECT_FALSE(slow.receive(std::chrono::milliseconds(0)));
  EXPECT_TRUE(has(slow.receive_all(), "\r\n\r\nslow?"));
}

TEST(PageServer, RefusesHostsThatAreNotItsOwn) {
  const EchoServer server;
  for (const char* host :
       {"evil.example", "localhost.evil.example", "8.8.8.8", "127.0.0.1.evil.example", "[::2]", "[::ffff:127.0.0.1]",
        "", "localhost:", "localhost:99999999", "a@localhost", "[::1", ":80", "0.0.0.0"})
    EXPECT_EQ(get(server.port(), "/secret/", std::string("Host: ") + host + "\r\n").status, 403) << host;
  for (const char* host : {"localhost", "LOCALHOST:1", "127.0.0.1:8080", "127.1.2.3", "[::1]", "[::1]:80"})
    EXPECT_EQ(get(server.port(), "/secret/", std::string("Host: ") + host + "\r\n").status, 200) << host;
  EXPECT_EQ(get(server.port(), "/secret/", "").status, 400);
  EXPECT_EQ(get(server.port(), "/secret/", "Host: localhost\r\nHost: localhost\r\n").status, 400);
  EXPECT_FALSE(has(get(server.port(), "/secret/", "Host: evil.example\r\n").header, "evil"));
}

TEST(PageServer, RefusesWhatIsNoRequest) {
  const EchoServer server;
  for (const char* request :
       {"nonsense\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/9.9\r\n\r\n", "GET / HTTP/1.1\r\nno colon\r\n\r\n",
        "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n"})
    EXPECT_EQ(ask(server.port(), request).status, 400) << request;
  EXPECT_EQ(get(server.port(), "/secret/", "Host: localhost\r\nX: " + std::string(9000, 'x') + "\r\n").status, 431);
  EXPECT_EQ(get(server.port(), '/' + std::string(9000, 'x')).status, 431);
  EXPECT_EQ(get(server.port(), "/secret/", "Host: localhost\r\nX: " + std::string(7000, 'x') + "\r\n").status, 200);
}

TEST(PageServer, ListensAtIpv6) {
  try {
    const PageServer server({.address = "::1", .token = "secret"}, {});
    EXPECT_EQ(server.url(), "http://[::1]:" + std::to_string(server.port()) + "/secret/");
  } catch (const InputError& error) {
    GTEST_SKIP() << "this machine has no IPv6: " << error.what();
  }
}

TEST(PageServer, NamesAnAddressThatOthersReach) {
  const PageServer server({.address = "0.0.0.0", .token = "secret"}, {});
  EXPECT_FALSE(has(server.url(), "0.0.0.0")) << server.url();
  EXPECT_EQ(get(server.port(), "/secret/").status, 200);
  const std::string host = server.url().substr(7, server.url().find("/secret") - 7);
  EXPECT_EQ(get(server.port(), "/secret/", "Host: " + host + "\r\n").status, 200) << host;
  EXPECT_EQ(get(server.port(), "/secret/", "Host: evil.example\r\n").status, 403);
  const PageServer named({.address = "localhost", .token = "secret"}, {});
  EXPECT_EQ(get(named.port(), "/secret/").status, 200);
}

TEST(PageServer, TakesTheNextPortUnlessOneIsMeant) {
  const PageServer first({}, {});
  const PageServer second({.port = first.port()}, {});
  EXPECT_GT(second.port(), first.port());
  const std::string error = error_of({.port = first.port(), .only_this_port = true});
  EXPECT_TRUE(has(error, "port " + std::to_string(first.port()) + ": another program is using it")) << error;
}

TEST(PageServer, SaysWhyItCannotListen) {
  EXPECT_TRUE(has(error_of({.port = -1}), "port -1: "));
  EXPECT_TRUE(has(error_of({.port = 65536}), "port 65536: "));
  for (const char* address :
       {"", "nonsense.invalid", "1.2.3.4.5", "256.1.1.1", "127.0.0.1:80", "[::1]", "a b", "\x1b[31m"}) {
    const std::string error = error_of({.address = address});
    EXPECT_TRUE(has(error, "address '")) << address << ": " << error;
    EXPECT_FALSE(has(error, "\x1b"));
  }
  // An address for documentation (RFC 5737), which no machine has.
  EXPECT_TRUE(has(error_of({.address = "203.0.113.7"}), "address '203.0.113.7': this machine does not have it"));
}

TEST(PageServer, SaysThatAPortIsTheAdministrators) {
  int first_free = 1024;
  std::ifstream("/proc/sys/net/ipv4/ip_unprivileged_port_start") >> first_free;
  if (::geteuid() == 0 || first_free <= 80) GTEST_SKIP() << "every port may be used here";
  EXPECT_TRUE(has(error_of({.port = 80}), "port 80: permission denied: "));
}

#else

TEST(PageServer, SaysWhatItIsBuiltWith) {
  try {
    const PageServer server({}, {});
    FAIL();
  } catch (const UnsupportedError& error) {
    EXPECT_NE(std::string(error.what()).find("apt install libboost-dev"), std::string::npos);
  }
}

#endif

}  // namespace
}  // namespace alhazen::impl
