// Order conditions of splitting methods, generated and not transcribed, in any arithmetic with + - * / and comparison.
// A step is a product of exponentials of vector fields; up to order p it has to be exp(h (A + B)).
//   words      the product is expanded in words of A (drift) and B (kick): the coefficient of every word of length n <=
//   p
//              has to be 1/n!. Holds for every H = T(p) + V(q).
//   graded     a composition of a symmetric step of order 2, which is exp(h Y1 + h^3 Y3 + h^5 Y5 + ...): words of the
//   words      letters Y1, Y3, ... with degrees that add up to at most p; 1/n! at the word Y1 ... Y1, else 0.
//   trees      for T = p^T M^-1 p/2 a splitting is a Runge-Kutta-Nystroem method for q'' = F(q), with Q_j = q + c_j h v
//   +
//              h^2 sum_(i<j) b_i (c_j - c_i) F(Q_i): special Nystroem trees.   [HNW1993, II.14]
//              Those of q follow from those of p, since the weights there are b_j (1 - c_j).
// Beside each defect stands the sum of the absolute values of its terms, of which rounding is a small multiple.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/methods/force_gradient.hpp"
#include "hamflow/methods/splitting.hpp"

namespace hamflow::test {

template <class R>
R magnitude(const R& x) {
  return x < R(0) ? -x : x;
}

/// What is left of a condition, and the size of its terms.
template <class R>
struct Defect {
  R value;
  R size;
  R relative() const { return magnitude(value) / size; }
};
template <class R>
using Defects = std::vector<Defect<R>>;

/// The largest defect relative to the size of its terms.
template <class R>
R worst(const Defects<R>& all) {
  R largest(0);
  for (const Defect<R>& d : all) {
    const R r = d.relative();
    if (largest < r) largest = r;
  }
  return largest;
}

/// A formal series in words of A and B up to a length; word w of length n stands at index 2^n + w, B a binary 1.
template <class R>
class WordSeries {
 public:
  explicit WordSeries(int longest) : longest_(longest), at_(std::size_t(2) << longest, R(0)) { at_[1] = R(1); }

  /// Times exp(x A) or exp(x B).
  void multiply(bool is_kick, const R& x) {
    // From the longest word to the shortest: what is read is shorter and still old.
    for (std::size_t word = at_.size(); word-- > 1;) {
      R sum = at_[word];
      R power(1);
      std::size_t rest = word;
      for (int k = 1; rest > 1 && ((rest & 1) != 0) == is_kick; ++k) {
        rest >>= 1;
        power = power * x / R(k);
        sum = sum + at_[rest] * power;
      }
      at_[word] = sum;
    }
  }
  /// Times exp(b B + g [B, [A, B]]), [B, [A, B]] = 2 BAB - BBA - ABB; in absolute values with +.
  void multiply_gradient(const R& b, const R& g, bool absolute = false) {
    const R minus = absolute ? g : -g;
    WordSeries term = *this;
    for (int k = 1; k <= longest_; ++k) {
      WordSeries next(longest_);
      next.at_[1] = R(0);
      for (std::size_t word = 1; word < at_.size(); ++word) {
        next.append(word, "B", term.at_[word] * b / R(k));
        next.append(word, "BAB", term.at_[word] * (g + g) / R(k));
        next.append(word, "BBA", term.at_[word] * minus / R(k));
        next.append(word, "ABB", term.at_[word] * minus / R(k));
      }
      for (std::size_t word = 1; word < at_.size(); ++word) at_[word] = at_[word] + next.at_[word];
      term = next;
    }
  }
  const std::vector<R>& coefficients() const { return at_; }

 private:
  void append(std::size_t word, const std::string& letters, const R& x) {
    for (const char letter : letters) word = 2 * word + (letter == 'B' ? 1 : 0);
    if (word < at_.size()) at_[word] = at_[word] + x;
  }
  int longest_;
  std::vector<R> at_;
};

/// coefficient - 1/n! at every word but the empty one. @param sizes the same series of absolute values
template <class R>
Defects<R> word_defects(const WordSeries<R>& series, const WordSeries<R>& sizes) {
  Defects<R> all;
  R inverse_factorial(1);
  int length = 0;
  for (std::size_t word = 2; word < series.coefficients().size(); ++word) {
    if ((word & (word - 1)) == 0) inverse_factorial = inverse_factorial / R(++length);
    all.push_back({series.coefficients()[word] - inverse_factorial, sizes.coefficients()[word] + inverse_factorial});
  }
  return all;
}

template <class R>
Defects<R> word_conditions(const SplittingSequence<R>& sequence, int order) {
  WordSeries<R> series(order);
  WordSeries<R> sizes(order);
  bool is_kick = sequence.kick_first();
  for (const R& c : sequence.coefficients) {
    series.multiply(is_kick, c);
    sizes.multiply(is_kick, magnitude(c));
    is_kick = !is_kick;
  }
  return word_defects(series, sizes);
}

template <class R>
Defects<R> word_conditions(const ForceGradientTable& table, int order) {
  WordSeries<R> series(order);
  WordSeries<R> sizes(order);
  for (int i = 0; i < table.count(); ++i) {
    const ForceGradientAction& action = table.action(i);
    if (action.kick.empty()) {
      const R d = evaluate_number<R>(action.drift);
      series.multiply(false, d);
      sizes.multiply(false, magnitude(d));
    } else {
      const R b = evaluate_number<R>(action.kick);
      const R g = action.gradient.empty() ? R(0) : evaluate_number<R>(action.gradient);
      series.multiply_gradient(b, g);
      sizes.multiply_gradient(magnitude(b), magnitude(g), true);
    }
  }
  return word_defects(series, sizes);
}

/// The words of Y1, Y3, Y5, ... up to a degree, shortest first.
struct GradedWords {
  struct Ending {
    std::size_t beginning;  // the word without it
    int degree;
    int length;
  };
  struct Word {
    std::vector<int> letters;
    int degree = 0;
    std::vector<Ending> endings;  // the empty one first
  };
  std::vector<Word> all{{{}, 0, {{0, 0, 0}}}};

  explicit GradedWords(int highest) {
    std::map<std::vector<int>, std::size_t> index{{{}, 0}};
    for (std::size_t k = 0; k < all.size(); ++k) {
      for (int letter = 1; all[k].degree + letter <= highest; letter += 2) {
        Word next{all[k].letters, all[k].degree + letter, {}};
        next.letters.push_back(letter);
        Ending ending{all.size(), 0, 0};
        next.endings.push_back(ending);
        for (std::vector<int> rest = next.letters; !rest.empty();) {
          ending.degree += rest.back();
          ++ending.length;
          rest.pop_back();
          ending.beginning = index.at(rest);
          next.endings.push_back(ending);
        }
        index[next.letters] = all.size();
        all.push_back(std::move(next));
      }
    }
  }
};

/// Conditions of StV(gamma_s h) o ... o StV(gamma_1 h).
template <class R>
Defects<R> composition_conditions(const std::vector<R>& gamma, const GradedWords& words) {
  std::vector<R> inverse_factorial{R(1)};
  for (int k = 1; k <= 16; ++k) inverse_factorial.push_back(inverse_factorial.back() / R(k));
  const auto product = [&](bool absolute) {
    std::vector<R> at(words.all.size(), R(0));
    at[0] = R(1);
    for (const R& g : gamma) {
      std::vector<R> power{R(1)};
      for (int k = 1; k <= 16; ++k) power.push_back(power.back() * (absolute ? magnitude(g) : g));
      for (std::size_t w = at.size(); w-- > 0;) {
        R sum(0);
        for (const GradedWords::Ending& ending : words.all[w].endings) {
          sum = sum + at[ending.beginning] * power[static_cast<std::size_t>(ending.degree)] *
                          inverse_factorial[static_cast<std::size_t>(ending.length)];
        }
        at[w] = sum;
      }
    }
    return at;
  };
  const std::vector<R> value = product(false);
  const std::vector<R> size = product(true);
  Defects<R> all;
  for (std::size_t w = 1; w < value.size(); ++w) {
    const auto length = words.all[w].letters.size();
    const bool repeats_first = static_cast<int>(length) == words.all[w].degree;
    const R wanted = repeats_first ? inverse_factorial[length] : R(0);
    all.push_back({value[w] - wanted, size[w] + wanted});
  }
  return all;
}

/// F(Q) differentiated: `leaves` arguments v, and one for each child, a derivative of F inside.
struct NystroemTree {
  int order;  // 1 + leaves + 2 for every F but the first
  int leaves;
  std::vector<std::size_t> children;  // indices of trees of lower order
};

class NystroemTrees {
 public:
  std::vector<NystroemTree> all;

  explicit NystroemTrees(int highest) {
    for (int order = 1; order <= highest; ++order) {
      std::vector<NystroemTree> added;
      for (int budget = 0; budget < order; ++budget) extend(order, order - 1 - budget, {}, 0, budget, added);
      all.insert(all.end(), added.begin(), added.end());
    }
  }

 private:
  /// Children in ascending order whose orders, each plus 1, add up to the budget.
  void extend(int order, int leaves, const std::vector<std::size_t>& children, std::size_t first, int budget,
              std::vector<NystroemTree>& out) const {
    if (budget == 0) out.push_back({order, leaves, children});
    for (std::size_t k = first; k < all.size() && all[k].order + 1 <= budget; ++k) {
      std::vector<std::size_t> more = children;
      more.push_back(k);
      extend(order, leaves, more, k, budget - all[k].order - 1, out);
    }
  }
};

namespace detail {
/// sum_j b_j Phi_j of every tree; in front the sum of the drifts.
template <class R>
std::vector<R> nystroem_weights(const SplittingSequence<R>& sequence, const NystroemTrees& trees, bool absolute) {
  std::vector<R> kicks;
  std::vector<R> before;  // the drift in front of each kick
  R drift(0);
  R total(0);
  bool is_kick = sequence.kick_first();
  for (const R& signed_c : sequence.coefficients) {
    const R c = absolute ? magnitude(signed_c) : signed_c;
    if (is_kick) {
      kicks.push_back(c);
      before.push_back(drift);
      drift = R(0);
    } else {
      drift = c;
      total = total + c;
    }
    is_kick = !is_kick;
  }
  const std::size_t stages = kicks.size();
  std::vector<R> node(stages, R(0));
  R time(0);
  for (std::size_t j = 0; j < stages; ++j) node[j] = time = time + before[j];

  std::vector<std::vector<R>> inside;  // sum_(i<j) b_i (c_j - c_i) Phi_i of each tree: a particle's motion
  std::vector<R> weights{total};
  for (const NystroemTree& tree : trees.all) {
    std::vector<R> value(stages, R(1));
    for (std::size_t j = 0; j < stages; ++j) {
      for (int k = 0; k < tree.leaves; ++k) value[j] = value[j] * node[j];
      for (const std::size_t child : tree.children) value[j] = value[j] * inside[child][j];
    }
    std::vector<R> sums(stages, R(0));
    R position(0);
    R speed(0);
    for (std::size_t j = 0; j < stages; ++j) {
      position = position + before[j] * speed;
      sums[j] = position;
      speed = speed + kicks[j] * value[j];
    }
    inside.push_back(sums);
    weights.push_back(speed);
  }
  return weights;
}

/// The same along the exact flow, where Phi(t) = factor t^power and sums are integrals over [0, 1].
template <class R>
std::vector<R> exact_nystroem_weights(const NystroemTrees& trees) {
  std::vector<std::pair<R, int>> phi;
  std::vector<R> weights{R(1)};
  for (const NystroemTree& tree : trees.all) {
    R factor(1);
    int power = tree.leaves;
    for (const std::size_t child : tree.children) {
      const auto& [inner, m] = phi[child];
      factor = factor * inner / R((m + 1) * (m + 2));
      power += m + 2;
    }
    phi.emplace_back(factor, power);
    weights.push_back(factor / R(power + 1));
  }
  return weights;
}
}  // namespace detail

template <class R>
Defects<R> nystroem_conditions(const SplittingSequence<R>& sequence, const NystroemTrees& trees) {
  const std::vector<R> value = detail::nystroem_weights(sequence, trees, false);
  const std::vector<R> size = detail::nystroem_weights(sequence, trees, true);
  const std::vector<R> wanted = detail::exact_nystroem_weights<R>(trees);
  Defects<R> all;
  for (std::size_t k = 0; k < value.size(); ++k) all.push_back({value[k] - wanted[k], size[k] + wanted[k]});
  return all;
}

}  // namespace hamflow::test
