#include "moves.hpp"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace hamflow::native {
namespace {

bool is_register(const Place& place) { return place.kind == Place::Kind::reg; }

/// Moves that have not been emitted. A move may not overwrite a place that another one still has to read.
class PendingMoves {
 public:
  PendingMoves(std::vector<Line>& lines, std::vector<Move> moves, std::uint32_t scratch,
               const std::function<Place()>& new_slot)
      : lines_(lines), moves_(std::move(moves)), scratch_{Place::Kind::reg, scratch}, new_slot_(new_slot) {
    std::erase_if(moves_, [](const Move& move) { return move.from == move.to; });
    for (const Move& move : moves_) ++readers_[key(move.from)];
    if (is_source(scratch_) && any_between_memory()) read_from(new_slot_(), scratch_);
  }

  void finish() {
    while (!moves_.empty()) {
      const auto free =
          std::find_if(moves_.begin(), moves_.end(), [&](const Move& move) { return !is_source(move.to); });
      if (free != moves_.end()) {
        const Move move = *free;
        *free = moves_.back();
        moves_.pop_back();
        --readers_[key(move.from)];
        emit(move.to, move.from);
      } else {
        // Only cycles are left, so the scratch register is free. It can hold a number unless a move from memory to
        // memory needs it.
        read_from(any_between_memory() ? new_slot_() : scratch_, moves_.front().from);
      }
    }
  }

 private:
  static std::uint64_t key(const Place& place) { return static_cast<std::uint64_t>(place.kind) << 32 | place.index; }
  bool is_source(const Place& place) const {
    const auto found = readers_.find(key(place));
    return found != readers_.end() && found->second > 0;
  }
  bool any_between_memory() const {
    return std::any_of(moves_.begin(), moves_.end(),
                       [](const Move& move) { return !is_register(move.from) && !is_register(move.to); });
  }
  void emit(const Place& to, const Place& from) {
    const auto line = [&](const Place& x, const Place& y) { lines_.push_back({Line::Kind::move, {}, {}, x, y, {}}); };
    if (is_register(to) || is_register(from)) {
      line(to, from);
    } else {
      line(scratch_, from);
      line(to, scratch_);
    }
  }
  /// Copies a source, and lets the moves that read it read the copy.
  void read_from(Place copy, Place source) {
    emit(copy, source);
    for (Move& move : moves_) {
      if (move.from == source) move.from = copy;
    }
    readers_[key(copy)] += std::exchange(readers_[key(source)], 0);
  }

  std::vector<Line>& lines_;
  std::vector<Move> moves_;
  Place scratch_;
  const std::function<Place()>& new_slot_;
  std::unordered_map<std::uint64_t, int> readers_;
};

}  // namespace

void append_moves(std::vector<Line>& lines, std::vector<Move> moves, std::uint32_t scratch,
                  const std::function<Place()>& new_slot) {
  PendingMoves(lines, std::move(moves), scratch, new_slot).finish();
}

}  // namespace hamflow::native
