// The server of the i-PI protocol: sends positions to a client, a program that computes energy and forces, and receives
// them. The protocol is that of [Ceriotti2014]: headers of 12 characters, numbers as the machine stores them, positions
// in bohr, energies in hartree and forces in hartree per bohr.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "hamflow/run/socket.hpp"

namespace hamflow {

/// The three vectors of the cell, one after the other, in bohr.
using Cell = std::array<double, 9>;

/// An energy in hartree with the forces in hartree per bohr.
struct WireForces {
  double energy = 0;
  std::vector<double> forces;
};

/// A server at one address. It waits for its client at the first evaluation, and tells the client to end when the
/// server ends.
class ForceServer {
 public:
  /// Thrown to leave a step after the caller has asked for a stop (hamflow/core/stop_question.hpp).
  struct Stopped {};

  /// The server at this address. Users of the same address share it as long as one of them exists.
  static std::shared_ptr<ForceServer> at(const std::string& address);
  explicit ForceServer(std::string address) : address_(std::move(address)) {}
  ~ForceServer();
  ForceServer(const ForceServer&) = delete;
  ForceServer& operator=(const ForceServer&) = delete;

  /// @param positions in bohr   @param timeout seconds to wait for a client, and for each answer
  /// @throws ClientError after which every call throws the same error, until restart()   @throws Stopped
  void evaluate(const std::vector<double>& positions, const Cell& cell, double timeout, WireForces& found);
  /// After a failure, waits for a new client at the next evaluation.
  void restart();

 private:
  using Seconds = double;
  [[noreturn]] void fail(const std::string& what);
  void listen();
  void accept_client(Seconds timeout);
  void close_client();
  void check_wait(double since, Seconds timeout, const std::string& what);
  void send(const void* bytes, std::size_t size, Seconds timeout);
  void send_header(const char* header, Seconds timeout);
  void receive(void* bytes, std::size_t size, Seconds timeout, const char* what);
  std::string receive_header(Seconds timeout, const char* what);
  void initialise(Seconds timeout);

  std::string address_;
  std::mutex mutex_;
  int listening_ = -1;
  int client_ = -1;
  std::string file_;     // of a Unix socket that was bound
  std::string failure_;  // empty: none
  std::vector<char> buffer_;
  std::vector<char> received_;  // a buffer; bytes from taken_ to arrived_ are not yet used
  std::size_t taken_ = 0, arrived_ = 0;
};

}  // namespace hamflow
