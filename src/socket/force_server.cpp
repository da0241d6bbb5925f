#include "force_server.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <thread>
#include <utility>

#include "hamflow/core/number.hpp"
#include "hamflow/core/stop_question.hpp"

namespace hamflow {

namespace {

constexpr std::size_t header_length = 12;
constexpr std::string_view by_name = "unix:";
/// Clients of i-PI look for the Unix socket NAME here.
constexpr const char* folder_of_sockets = "/tmp/ipi_";
constexpr std::int32_t most_extra_bytes = 1 << 26;
constexpr std::size_t most_received = 1 << 16;
constexpr int wait_part = 100'000;  // microseconds, after which a requested stop is noticed

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string system_error() { return std::strerror(errno); }

/// The port of "127.0.0.1:PORT" or "localhost:PORT"; 0 if the text has another form.
int port_of(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  if (colon == std::string::npos) return 0;
  const std::string host = address.substr(0, colon);
  const std::string port = address.substr(colon + 1);
  if ((host != "127.0.0.1" && host != "localhost") || port.empty() || port.size() > 5) return 0;
  if (!std::all_of(port.begin(), port.end(), [](char c) { return c >= '0' && c <= '9'; })) return 0;
  const int number = std::stoi(port);
  return number <= 65535 ? number : 0;
}

sockaddr_un unix_address(const std::string& file) {
  sockaddr_un place{};
  place.sun_family = AF_UNIX;
  std::copy(file.begin(), file.end(), place.sun_path);
  return place;
}

const sockaddr* as_any(const auto& place) { return reinterpret_cast<const sockaddr*>(&place); }  // as POSIX demands

/// Whether a program listens at a Unix socket. If none does, the file is left over from a program that was killed.
bool is_in_use(const sockaddr_un& place) {
  const int probe = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool connected = ::connect(probe, as_any(place), sizeof place) == 0;
  ::close(probe);
  return connected;
}

/// A header as it can be shown: other bytes than letters may come from a program that speaks another protocol.
std::string shown_header(const std::string& header) {
  std::string text;
  for (const char c : header) text += c >= ' ' && c <= '~' ? c : '?';
  text.erase(text.find_last_not_of(' ') + 1);
  return "\"" + text + "\"";
}

void append(std::vector<char>& buffer, const void* bytes, std::size_t size) {
  const auto* const from = static_cast<const char*>(bytes);
  buffer.insert(buffer.end(), from, from + size);
}

/// The matrix with the vectors of the cell as columns, row by row, and its inverse.
std::array<double, 18> wire_cell(const Cell& cell) {
  std::array<double, 18> both{};
  const auto at = [&](std::size_t vector, std::size_t k) { return cell[3 * (vector % 3) + k % 3]; };
  double volume = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    volume += at(0, k) * (at(1, k + 1) * at(2, k + 2) - at(1, k + 2) * at(2, k + 1));
  }
  for (std::size_t v = 0; v < 3; ++v) {
    for (std::size_t k = 0; k < 3; ++k) {
      both[3 * k + v] = at(v, k);
      both[9 + 3 * v + k] = (at(v + 1, k + 1) * at(v + 2, k + 2) - at(v + 1, k + 2) * at(v + 2, k + 1)) / volume;
    }
  }
  return both;
}

}  // namespace

std::string refused_address(const std::string& address) {
  if (address.starts_with(by_name)) {
    const std::string name = address.substr(by_name.size());
    const auto is_plain = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
             c == '.';
    };
    if (!name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), is_plain)) return {};
    return "found \"" + address + "\"; allowed unix:NAME with 1 to 64 letters, digits, '_', '-' and '.' in NAME";
  }
  if (port_of(address) > 0) return {};
  return "found \"" + address +
         "\"; allowed unix:NAME or 127.0.0.1:PORT with a port from 1 to 65535, because only programs on this machine "
         "may connect";
}

std::shared_ptr<ForceServer> ForceServer::at(const std::string& address) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<ForceServer>> servers;
  const std::scoped_lock lock(mutex);
  std::shared_ptr<ForceServer> server = servers[address].lock();
  if (!server) servers[address] = server = std::make_shared<ForceServer>(address);
  return server;
}

ForceServer::~ForceServer() {
  if (client_ >= 0) (void)::send(client_, "EXIT        ", header_length, MSG_NOSIGNAL | MSG_DONTWAIT);
  close_client();
  if (listening_ >= 0) ::close(listening_);
  if (!file_.empty()) ::unlink(file_.c_str());
}

void ForceServer::restart() {
  const std::scoped_lock lock(mutex_);
  failure_.clear();
}

void ForceServer::fail(const std::string& what) {
  close_client();
  failure_ = "the client of problem." + std::string(SocketKeys::address) + " = \"" + address_ + "\" " + what;
  throw ClientError(failure_);
}

void ForceServer::close_client() {
  if (client_ >= 0) ::close(client_);
  client_ = -1;
  taken_ = arrived_ = 0;
}

void ForceServer::listen() {
  const auto refuse = [&](const std::string& what) {
    if (listening_ >= 0) ::close(listening_);
    listening_ = -1;
    throw ClientError("problem." + std::string(SocketKeys::address) + " = \"" + address_ +
                      "\" cannot be used: " + what);
  };
  if (!address_.starts_with(by_name)) {
    listening_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const int yes = 1;
    (void)::setsockopt(listening_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(static_cast<std::uint16_t>(port_of(address_)));
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::bind(listening_, as_any(place), sizeof place) != 0) refuse(system_error());
  } else {
    listening_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const std::string file = folder_of_sockets + address_.substr(by_name.size());
    const sockaddr_un place = unix_address(file);
    if (::bind(listening_, as_any(place), sizeof place) != 0) {
      if (errno != EADDRINUSE) refuse(file + ": " + system_error());
      if (is_in_use(place)) refuse("another program listens at " + file);
      ::unlink(file.c_str());
      if (::bind(listening_, as_any(place), sizeof place) != 0) refuse(file + ": " + system_error());
    }
    file_ = file;
    ::chmod(file.c_str(), S_IRUSR | S_IWUSR);  // before listen(), so that no other user can connect
  }
  if (::listen(listening_, 1) != 0) refuse(system_error());
}

/// Called after each part of a wait. A stop that was requested ends the wait.
void ForceServer::check_wait(double since, Seconds timeout, const std::string& what) {
  if (StopQuestion::stop_requested()) {
    close_client();  // the answer that is still to come belongs to a step that is not taken
    throw Stopped{};
  }
  if (seconds_now() - since > timeout) {
    fail(what + " within problem." + SocketKeys::timeout + " = " + shortest(timeout) + " seconds");
  }
}

void ForceServer::accept_client(Seconds timeout) {
  if (listening_ < 0) listen();
  const double begin = seconds_now();
  pollfd entry{listening_, POLLIN, 0};
  while (::poll(&entry, 1, wait_part / 1000) <= 0) check_wait(begin, timeout, "did not connect");
  client_ = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
  if (client_ < 0) fail("could not be accepted: " + system_error());
  const int yes = 1;
  if (!address_.starts_with(by_name)) (void)::setsockopt(client_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  // send() and recv() wait themselves, in parts: a call of poll() for each would double the time of a small system.
  const timeval part{0, wait_part};
  (void)::setsockopt(client_, SOL_SOCKET, SO_RCVTIMEO, &part, sizeof part);
  (void)::setsockopt(client_, SOL_SOCKET, SO_SNDTIMEO, &part, sizeof part);
}

void ForceServer::send(const void* bytes, std::size_t size, Seconds timeout) {
  const auto* from = static_cast<const char*>(bytes);
  const double begin = seconds_now();
  while (size > 0) {
    const ssize_t sent = ::send(client_, from, size, MSG_NOSIGNAL);
    if (sent > 0) {
      from += sent;
      size -= static_cast<std::size_t>(sent);
    } else if (sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) {
      check_wait(begin, timeout, "did not read the positions");
    } else {
      fail("ended the connection");
    }
  }
}

void ForceServer::send_header(const char* header, Seconds timeout) { send(header, header_length, timeout); }

void ForceServer::receive(void* bytes, std::size_t size, Seconds timeout, const char* what) {
  auto* to = static_cast<char*>(bytes);
  const double begin = seconds_now();
  while (size > 0) {
    if (taken_ < arrived_) {
      const std::size_t count = std::min(size, arrived_ - taken_);
      std::memcpy(to, received_.data() + taken_, count);
      taken_ += count;
      to += count;
      size -= count;
      continue;
    }
    received_.resize(most_received);
    const ssize_t received = ::recv(client_, received_.data(), received_.size(), 0);
    taken_ = 0;
    arrived_ = received > 0 ? static_cast<std::size_t>(received) : 0;
    if (received > 0) continue;
    if (received < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) {
      check_wait(begin, timeout, std::string("did not send ") + what);
    } else {
      fail(std::string("ended the connection before it sent ") + what);
    }
  }
}

std::string ForceServer::receive_header(Seconds timeout, const char* what) {
  std::string header(header_length, ' ');
  receive(header.data(), header_length, timeout, what);
  return header;
}

/// Asks a new client for its status. A client that needs a text for its start gets an empty one.
void ForceServer::initialise(Seconds timeout) {
  for (bool begun = false;;) {
    send_header("STATUS      ", timeout);
    const std::string status = receive_header(timeout, "its status");
    if (status == "READY       ") return;
    if (status != "NEEDINIT    " || begun) {
      fail("sent " + shown_header(status) + " in reply to STATUS; allowed READY, or NEEDINIT once");
    }
    begun = true;
    const std::int32_t words[] = {0, 1};  // the number of the replica, and of characters
    buffer_.clear();
    append(buffer_, "INIT        ", header_length);
    append(buffer_, words, sizeof words);
    append(buffer_, " ", 1);
    send(buffer_.data(), buffer_.size(), timeout);
  }
}

void ForceServer::evaluate(const std::vector<double>& positions, const Cell& cell, double timeout, WireForces& found) {
  const std::scoped_lock lock(mutex_);
  if (!failure_.empty()) throw ClientError(failure_);
  if (client_ < 0) {
    accept_client(timeout);
    initialise(timeout);
  }
  const auto atoms = static_cast<std::int32_t>(positions.size() / 3);
  const std::array<double, 18> cells = wire_cell(cell);
  buffer_.clear();
  append(buffer_, "POSDATA     ", header_length);
  append(buffer_, cells.data(), sizeof cells);
  append(buffer_, &atoms, sizeof atoms);
  append(buffer_, positions.data(), positions.size() * sizeof(double));
  append(buffer_, "STATUS      ", header_length);
  send(buffer_.data(), buffer_.size(), timeout);
  for (;;) {
    const std::string status = receive_header(timeout, "its status");
    if (status == "HAVEDATA    ") break;
    if (status != "READY       ") fail("sent " + shown_header(status) + " after POSDATA; allowed HAVEDATA, or READY");
    // Some clients answer while they compute.
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    send_header("STATUS      ", timeout);
  }
  send_header("GETFORCE    ", timeout);
  const std::string answer = receive_header(timeout, "its forces");
  if (answer != "FORCEREADY  ") fail("sent " + shown_header(answer) + " in reply to GETFORCE; allowed FORCEREADY");
  std::int32_t count = 0;
  receive(&found.energy, sizeof found.energy, timeout, "its energy");
  receive(&count, sizeof count, timeout, "its number of atoms");
  if (count != atoms) {
    fail("sent forces for " + std::to_string(count) + " atoms; allowed " + std::to_string(atoms) +
         ", the number of atoms of problem.initial");
  }
  found.forces.resize(positions.size());
  receive(found.forces.data(), found.forces.size() * sizeof(double), timeout, "its forces");
  double virial[9];
  std::int32_t extra = 0;
  receive(virial, sizeof virial, timeout, "its virial");
  receive(&extra, sizeof extra, timeout, "the length of its extra text");
  if (extra < 0 || extra > most_extra_bytes) {
    fail("sent the length " + std::to_string(extra) + " of its extra text; allowed 0 to " +
         std::to_string(most_extra_bytes));
  }
  buffer_.resize(static_cast<std::size_t>(extra));
  receive(buffer_.data(), buffer_.size(), timeout, "its extra text");
  if (!std::isfinite(found.energy)) fail("sent the energy " + shortest(found.energy) + "; allowed a finite number");
  const auto wrong = std::find_if(found.forces.begin(), found.forces.end(), [](double f) { return !std::isfinite(f); });
  if (wrong != found.forces.end()) {
    fail("sent the force " + shortest(*wrong) + " on atom " + std::to_string((wrong - found.forces.begin()) / 3 + 1) +
         "; allowed finite numbers");
  }
}

}  // namespace hamflow
