// In the place of page_server.cpp where the program is built without Boost.

#include "util/diagnostics.h"
#include "view/page_server.h"

namespace alhazen::impl {

class PageServer::Implementation {};

PageServer::PageServer(const PageServerOptions&, PageEvents) {
  throw UnsupportedError("serving a page needs Boost: apt install libboost-dev, and build again");
}

PageServer::~PageServer() = default;

int PageServer::port() const { return 0; }

std::string PageServer::url() const { return {}; }

bool PageServer::is_local() const { return true; }

void PageServer::send_text(ViewerId, std::shared_ptr<const std::string>) {}

void PageServer::send_binary(ViewerId, std::shared_ptr<const std::string>) {}

size_t PageServer::queued_bytes(ViewerId) const { return 0; }

size_t PageServer::viewers() const { return 0; }

}  // namespace alhazen::impl
