// Neighbour lists: for each particle, the particles within the cut-off plus a skin, in the order of their numbers.
// Lists are valid until the two largest displacements add up to the skin.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hamflow/detail/core/thread_team.hpp"
#include "kernel.hpp"

namespace hamflow::bulk {

/// Memory that is aligned for registers of any width. Resizing sets all numbers to 0.
class Numbers {
 public:
  void resize(std::size_t size) {
    memory_.assign(size + 8, 0.0);
    const auto address = reinterpret_cast<std::uintptr_t>(memory_.data());
    offset_ = (64 - address % 64) % 64 / sizeof(double);
  }
  double* data() { return memory_.data() + offset_; }
  const double* data() const { return memory_.data() + offset_; }
  double& operator[](std::size_t i) { return data()[i]; }
  double operator[](std::size_t i) const { return data()[i]; }

 private:
  std::vector<double> memory_;
  std::size_t offset_ = 0;
};

class Neighbours {
 public:
  struct Box {
    std::size_t space = 2;
    std::array<double, 3> edges{};  // 0: not periodic
    double radius = 0;              // the cut-off
    double skin = 0;
  };
  /// The rows that one worker sums at a time.
  struct Block {
    std::size_t first = 0;  // the first slot
    std::size_t last = 0;
    std::size_t first_cell = 0;
    std::size_t last_cell = 0;
    std::vector<std::uint32_t> slots{};
    std::vector<std::uint32_t> begins{};
    std::vector<std::uint32_t> counts{};
    Candidates candidates() const { return {slots.data(), begins.data(), counts.data()}; }
  };

  /// @param workers the number of threads that make lists at the same time
  void prepare(const Box& box, std::size_t particles, std::size_t workers);
  /// Copies positions to their slots. @return whether the lists are still valid; false before the first ones are made
  bool place(const double* q, ThreadTeam* team);
  /// Makes new lists and places the particles. @param near functions without and with periodic images
  void make(const double* q, const FindNear* near, ThreadTeam* team);

  std::span<const Block> blocks() const { return {blocks_.data(), used_blocks_}; }
  std::size_t longest_row() const { return longest_; }
  void show(Rows& rows) const;
  /// Sets the fourth number of each slot, after lists are made. @param strengths by particle; empty: all are 1
  void set_strengths(const std::vector<double>& strengths);

 private:
  /// The scratch memory of one thread.
  struct ThreadScratch {
    // The particles in and around a cell, in the order of their numbers.
    Numbers x[3];
    std::vector<std::uint32_t> slots;
    std::vector<std::uint32_t> own;  // indices of the particles in the cell itself
    std::size_t count = 0;
    std::vector<std::uint32_t> rows;  // the rows of a block
    // One bit for each particle, and one bit for each word of these bits.
    std::array<std::vector<std::uint64_t>, 2> marks;
    double moved[2] = {0, 0};  // the two largest squared displacements
  };
  double wrapped(double x, std::size_t k) const;
  void lay_cells(const double* q);
  void sort_into_cells(const double* q);
  void divide_rows();
  void clear_scratch();
  void enlarge_scratch();
  std::size_t cells_beside(std::size_t cell, std::size_t* beside) const;
  void gather(std::size_t cell, ThreadScratch& scratch) const;
  void find_rows(Block& block, ThreadScratch& scratch, const FindNear* near) const;
  template <std::size_t Space>
  void place_slots(const double* q, std::size_t first, std::size_t last, ThreadScratch& scratch);

  Box box_;
  std::size_t particles_ = 0;
  double reach_ = 0;  // the range of the lists
  std::array<std::size_t, 3> cells_{1, 1, 1};
  std::array<double, 3> corner_{};
  std::array<double, 3> cell_edge_{};
  std::vector<std::uint32_t> cell_of_;  // by particle
  std::vector<std::size_t> cell_begins_;
  std::vector<std::uint32_t> number_;   // by slot
  std::vector<std::uint32_t> slot_of_;  // by particle
  std::vector<unsigned char> plain_;    // by slot
  Numbers at_;                          // by slot
  Numbers x_[3];                        // positions by slot, when the lists were made
  Numbers made_at_;                     // the same, unwrapped
  std::vector<Block> blocks_;
  std::size_t used_blocks_ = 0;
  std::vector<ThreadScratch> scratch_;
  std::size_t longest_ = 0;
  bool by_shift_ = true;  // whether only the images nearest to a cell can be in range
  bool made_ = false;
};

}  // namespace hamflow::bulk
