#include "neighbours.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "hamflow/core/math.hpp"

namespace hamflow::bulk {

namespace {
constexpr std::size_t rows_each = 64;  // minimum number of rows of a block
/// A relative margin for rounding at limits.
constexpr double margin = 1e-9;
constexpr std::size_t worth_sharing = 4096;

/// Rounds |x| < 2^51 to the nearest whole number, as the kernels do.
double nearest(double x) { return (x + 0x1.8p52) - 0x1.8p52; }

/// Reserves extra space, because later lists may be longer when particles move into the cells of a block. Unused memory
/// costs nothing.
void make_room(std::size_t size, std::vector<std::uint32_t>& list) {
  if (list.capacity() < size + size / 2) list.reserve(2 * size + 64);
}

/// Calls work(worker, block) for each block, on all threads of the team.
template <class Work>
void share(ThreadTeam* team, std::size_t blocks, const Work& work) {
  if (team == nullptr || blocks < 2) {
    for (std::size_t b = 0; b < blocks; ++b) work(std::size_t{0}, b);
    return;
  }
  auto job = [&](std::size_t worker, std::uint64_t, std::size_t block) { work(worker, block); };
  team->share(blocks, job);
}
}  // namespace

void Neighbours::prepare(const Box& box, std::size_t particles, std::size_t workers) {
  box_ = box;
  particles_ = particles;
  reach_ = (box.radius + box.skin) * (1 + margin);
  scratch_.resize(workers);
  for (ThreadScratch& scratch : scratch_) {
    std::size_t words = particles;
    for (auto& level : scratch.marks) {
      words = (words + 63) / 64;
      level.assign(words, 0);
    }
  }
  cell_of_.resize(particles);
  number_.resize(particles);
  slot_of_.resize(particles);
  plain_.resize(particles);
  at_.resize(4 * particles);
  for (std::size_t k = 0; k < box.space; ++k) x_[k].resize(particles + 8);
  made_at_.resize(box.space * particles);
  made_ = false;
}

inline double Neighbours::wrapped(double x, std::size_t k) const {
  const double edge = box_.edges[k];
  // For most particles the quotient rounds to 0. This test gives the same result without a division.
  if (std::abs(x) < 0.499 * edge || edge == 0) return x;
  return x - nearest(x / edge) * edge;
}

/// Chooses cells that are at least as large as the range of the lists, and not many more than there are particles.
void Neighbours::lay_cells(const double* q) {
  const std::size_t space = box_.space;
  double most = 1;
  for (std::size_t k = 0; k < space; ++k) {
    double low = -box_.edges[k] / 2;
    double high = box_.edges[k] / 2;
    if (box_.edges[k] == 0) {
      low = high = q[k];
      for (std::size_t i = 0; i < particles_; ++i) {
        low = std::min(low, q[i * space + k]);
        high = std::max(high, q[i * space + k]);
      }
    }
    corner_[k] = low;
    const double across = high - low;
    const double count = std::min(std::floor(across / reach_), 1e6);
    cells_[k] = count < 1 ? 1 : static_cast<std::size_t>(count);
    cell_edge_[k] = across;
    most *= static_cast<double>(cells_[k]);
  }
  const double allowed = static_cast<double>(2 * particles_ + 64);
  if (most > allowed) {
    const double shrink = pow(allowed / most, 1 / static_cast<double>(space));
    for (std::size_t k = 0; k < space; ++k) {
      cells_[k] = std::max<std::size_t>(1, static_cast<std::size_t>(static_cast<double>(cells_[k]) * shrink));
    }
  }
  for (std::size_t k = 0; k < space; ++k) cell_edge_[k] /= static_cast<double>(cells_[k]);
  for (std::size_t k = space; k < 3; ++k) cells_[k] = 1;
}

/// Sorts particles into cells by counting, so that numbers ascend within a cell.
void Neighbours::sort_into_cells(const double* q) {
  const std::size_t space = box_.space;
  const std::size_t cells = cells_[0] * cells_[1] * cells_[2];
  cell_begins_.assign(cells + 1, 0);
  for (std::size_t i = 0; i < particles_; ++i) {
    std::size_t cell = 0;
    for (std::size_t k = space; k-- > 0;) {
      const double place = (wrapped(q[i * space + k], k) - corner_[k]) / cell_edge_[k];
      const double last = static_cast<double>(cells_[k] - 1);
      // The quotient is NaN if all particles have the same coordinate.
      cell = cell * cells_[k] + (place > 0 ? static_cast<std::size_t>(std::min(place, last)) : 0);
    }
    cell_of_[i] = static_cast<std::uint32_t>(cell);
    ++cell_begins_[cell + 1];
  }
  for (std::size_t c = 0; c < cells; ++c) cell_begins_[c + 1] += cell_begins_[c];
  for (std::size_t i = 0; i < particles_; ++i) {
    const std::size_t slot = cell_begins_[cell_of_[i]]++;
    number_[slot] = static_cast<std::uint32_t>(i);
    slot_of_[i] = static_cast<std::uint32_t>(slot);
  }
  for (std::size_t c = cells; c > 0; --c) cell_begins_[c] = cell_begins_[c - 1];
  cell_begins_[0] = 0;
}

/// Chooses the number of cells per block so that a block has enough rows on average. Blocks keep their memory.
void Neighbours::divide_rows() {
  const std::size_t cells = cell_begins_.size() - 1;
  const std::size_t each = std::min(cells, rows_each * cells / particles_ + 1);
  used_blocks_ = (cells + each - 1) / each;
  if (blocks_.size() < used_blocks_) blocks_.resize(used_blocks_);
  for (std::size_t b = 0; b < used_blocks_; ++b) {
    Block& block = blocks_[b];
    block.first_cell = b * each;
    block.last_cell = std::min(cells, (b + 1) * each);
    block.first = cell_begins_[block.first_cell];
    block.last = cell_begins_[block.last_cell];
  }
}

/// Lists the cell and its neighbours, each once. @return their number
std::size_t Neighbours::cells_beside(std::size_t cell, std::size_t* beside) const {
  const std::size_t at[3] = {cell % cells_[0], cell / cells_[0] % cells_[1], cell / cells_[0] / cells_[1]};
  std::size_t near[3][3];
  std::size_t count[3] = {0, 0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t all = cells_[k];
    if (all <= 2) {
      for (std::size_t c = 0; c < all; ++c) near[k][count[k]++] = c;
      continue;
    }
    const bool periodic = box_.edges[k] != 0;
    if (at[k] > 0 || periodic) near[k][count[k]++] = (at[k] + all - 1) % all;
    near[k][count[k]++] = at[k];
    if (at[k] + 1 < all || periodic) near[k][count[k]++] = (at[k] + 1) % all;
  }
  std::size_t found = 0;
  for (std::size_t c = 0; c < count[2]; ++c) {
    for (std::size_t b = 0; b < count[1]; ++b) {
      for (std::size_t a = 0; a < count[0]; ++a) {
        beside[found++] = (near[2][c] * cells_[1] + near[1][b]) * cells_[0] + near[0][a];
      }
    }
  }
  return found;
}

/// Gathers the particles in and around a cell in the order of their numbers: it marks them in a bit set and reads the
/// set in order. If cells are small compared with the box, it takes the images that are nearest to the cell.
void Neighbours::gather(std::size_t cell, ThreadScratch& scratch) const {
  auto& [marks, words] = scratch.marks;
  std::size_t beside[27];
  const std::size_t cells = cells_beside(cell, beside);
  std::size_t lowest = words.size();
  std::size_t highest = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    const std::size_t begin = cell_begins_[beside[c]];
    const std::size_t end = cell_begins_[beside[c] + 1];
    if (begin == end) continue;
    // Numbers ascend within a cell, so most marks belong to one word of the upper level, and are written together.
    std::size_t word = number_[begin] / 4096;
    std::uint64_t in_word = 0;
    lowest = std::min(lowest, word);
    for (std::size_t slot = begin; slot < end; ++slot) {
      const std::size_t number = number_[slot];
      marks[number / 64] |= std::uint64_t{1} << (number % 64);
      if (number / 4096 != word) {
        words[word] |= in_word;
        word = number / 4096;
        in_word = 0;
      }
      in_word |= std::uint64_t{1} << (number / 64 % 64);
    }
    words[word] |= in_word;
    highest = std::max(highest, word);
  }
  std::uint32_t* const slots = scratch.slots.data();
  const std::size_t first_own = cell_begins_[cell];
  const std::size_t all_own = cell_begins_[cell + 1] - first_own;
  std::size_t own = 0;
  std::size_t found = 0;
  for (std::size_t a = lowest; a <= highest; ++a) {
    for (std::uint64_t in_a = std::exchange(words[a], 0); in_a != 0; in_a &= in_a - 1) {
      const std::size_t b = 64 * a + static_cast<std::size_t>(std::countr_zero(in_a));
      for (std::uint64_t in_b = std::exchange(marks[b], 0); in_b != 0; in_b &= in_b - 1) {
        const std::uint32_t slot = slot_of_[64 * b + static_cast<std::size_t>(std::countr_zero(in_b))];
        slots[found] = slot;
        scratch.own[own] = static_cast<std::uint32_t>(found);
        own += slot - first_own < all_own ? 1 : 0;
        ++found;
      }
    }
  }
  scratch.count = found;
  std::size_t rest = cell;
  for (std::size_t k = 0; k < box_.space; ++k) {
    const std::size_t at = rest % cells_[k];
    rest /= cells_[k];
    const double* const from = x_[k].data();
    double* const to = scratch.x[k].data();
    const bool inside = at > 0 && at + 1 < cells_[k];
    if (!by_shift_ || box_.edges[k] == 0 || inside) {
      for (std::size_t i = 0; i < found; ++i) to[i] = from[slots[i]];
      continue;
    }
    const double middle = corner_[k] + (static_cast<double>(at) + 0.5) * cell_edge_[k];
    const double inverse = 1 / box_.edges[k];
    for (std::size_t i = 0; i < found; ++i) {
      const double x = from[slots[i]];
      to[i] = x - nearest((x - middle) * inverse) * box_.edges[k];
    }
  }
}

/// Finds the rows of a block, in the order of the slots. They are written to the scratch memory of the thread first, so
/// that a block is allocated only once, with the right size.
void Neighbours::find_rows(Block& block, ThreadScratch& scratch, const FindNear* near) const {
  std::vector<std::uint32_t>& rows = scratch.rows;
  std::size_t used = 0;
  if (!made_) {
    make_room(block.last - block.first, block.begins);
    make_room(block.last - block.first, block.counts);
  }
  block.begins.clear();
  block.counts.clear();
  for (std::size_t cell = block.first_cell; cell < block.last_cell; ++cell) {
    const std::size_t own = cell_begins_[cell + 1] - cell_begins_[cell];
    if (own == 0) continue;
    gather(cell, scratch);
    CandidateParticles candidates{};
    candidates.slots = scratch.slots.data();
    candidates.count = scratch.count;
    candidates.radius_squared = reach_ * reach_;
    for (std::size_t k = 0; k < box_.space; ++k) {
      candidates.x[k] = scratch.x[k].data();
      candidates.edge[k] = box_.edges[k];
      candidates.inverse_edge[k] = box_.edges[k] == 0 ? 0 : 1 / box_.edges[k];
    }
    for (std::size_t i = 0; i < own; ++i) {
      if (rows.size() < used + scratch.count + 16) rows.resize(2 * (used + scratch.count + 16));
      const std::size_t count = near[by_shift_ ? 0 : 1](candidates, scratch.own[i], rows.data() + used);
      block.begins.push_back(static_cast<std::uint32_t>(used));
      block.counts.push_back(static_cast<std::uint32_t>(count));
      used += count;
      while (used % 8 != 0) rows[used++] = scratch.slots[scratch.own[i]];
    }
  }
  if (!made_) make_room(used, block.slots);
  block.slots.assign(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(used));
}

/// Resizes the scratch memory for the particles in and around any cell.
void Neighbours::clear_scratch() {
  std::size_t most = 0;
  for (std::size_t c = 0; c + 1 < cell_begins_.size(); ++c) {
    most = std::max(most, cell_begins_[c + 1] - cell_begins_[c]);
  }
  const std::size_t needed = std::min(particles_, 27 * most) + 8;
  for (ThreadScratch& scratch : scratch_) {
    if (scratch.slots.size() >= needed) continue;
    const std::size_t room = needed + needed / 4;
    scratch.slots.resize(room);
    scratch.own.resize(room);
    for (std::size_t k = 0; k < box_.space; ++k) scratch.x[k].resize(room);
  }
}

/// Resizes the scratch memory for the rows of any block, with extra space as in blocks.
void Neighbours::enlarge_scratch() {
  std::size_t most = 0;
  for (const Block& block : blocks()) most = std::max(most, block.slots.size());
  for (ThreadScratch& scratch : scratch_) {
    const std::size_t room = 2 * most + scratch.slots.size() + 16;
    if (scratch.rows.size() < room) scratch.rows.resize(room);
  }
}

void Neighbours::make(const double* q, const FindNear* near, ThreadTeam* team) {
  const std::size_t space = box_.space;
  lay_cells(q);
  sort_into_cells(q);
  divide_rows();
  clear_scratch();
  // A particle is deep in the box if no periodic image of another one can come into its range while the lists are
  // valid.
  double deep[3] = {};
  bool any_deep = true;
  by_shift_ = true;
  for (std::size_t k = 0; k < space; ++k) {
    const double edge = box_.edges[k];
    const double moved = box_.skin * (1 + margin);
    deep[k] = edge == 0 ? std::numeric_limits<double>::infinity() : edge / 2 * (1 - margin) - moved - reach_;
    any_deep = any_deep && deep[k] >= 0;
    by_shift_ = by_shift_ && (edge == 0 || cells_[k] >= 3);
  }
  for (std::size_t slot = 0; slot < particles_; ++slot) {
    bool plain = any_deep;
    for (std::size_t k = 0; k < space; ++k) {
      const double x = q[number_[slot] * space + k];
      x_[k][slot] = wrapped(x, k);
      made_at_[slot * space + k] = x;
      plain = plain && std::abs(x_[k][slot]) <= deep[k];
    }
    plain_[slot] = plain;
  }
  share(team, used_blocks_, [&](std::size_t worker, std::size_t b) { find_rows(blocks_[b], scratch_[worker], near); });
  if (!made_) enlarge_scratch();
  longest_ = 0;
  for (const Block& block : blocks()) {
    for (const std::uint32_t count : block.counts) longest_ = std::max<std::size_t>(longest_, count);
  }
  made_ = true;
  place(q, team);
}

template <std::size_t Space>
void Neighbours::place_slots(const double* q, std::size_t first, std::size_t last, ThreadScratch& scratch) {
  double most = 0;
  double next = 0;
  for (std::size_t slot = first; slot < last; ++slot) {
    double moved = 0;
    for (std::size_t k = 0; k < Space; ++k) {
      const double x = q[number_[slot] * Space + k];
      const double d = x - made_at_[slot * Space + k];
      moved += d * d;
      at_[4 * slot + k] = wrapped(x, k);
    }
    next = std::max(next, std::min(most, moved));
    most = std::max(most, moved);
  }
  scratch.moved[1] = std::max({scratch.moved[1], next, std::min(scratch.moved[0], most)});
  scratch.moved[0] = std::max(scratch.moved[0], most);
}

bool Neighbours::place(const double* q, ThreadTeam* team) {
  if (!made_) return false;
  for (ThreadScratch& scratch : scratch_) scratch.moved[0] = scratch.moved[1] = 0;
  const std::size_t pieces = particles_ < worth_sharing ? 1 : particles_ / 1024;
  share(team, pieces, [&](std::size_t worker, std::size_t piece) {
    const std::size_t first = particles_ * piece / pieces;
    const std::size_t last = particles_ * (piece + 1) / pieces;
    if (box_.space == 2) {
      place_slots<2>(q, first, last, scratch_[worker]);
    } else {
      place_slots<3>(q, first, last, scratch_[worker]);
    }
  });
  double most = 0;
  double next = 0;
  for (const ThreadScratch& scratch : scratch_) {
    next = std::max({next, scratch.moved[1], std::min(most, scratch.moved[0])});
    most = std::max(most, scratch.moved[0]);
  }
  return std::sqrt(most) + std::sqrt(next) <= box_.skin;
}

void Neighbours::set_strengths(const std::vector<double>& strengths) {
  for (std::size_t slot = 0; slot < particles_; ++slot) {
    at_[4 * slot + 3] = strengths.empty() ? 1 : strengths[number_[slot]];
  }
}

void Neighbours::show(Rows& rows) const {
  rows.at = at_.data();
  rows.number = number_.data();
  rows.plain = plain_.data();
}

}  // namespace hamflow::bulk
