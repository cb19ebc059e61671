// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace gaitd::daemon {

/// Work of several clients, each with a share of its own: the next item is that of the client that
/// was served longest ago, so that whoever sends much waits for itself and not the others for it.
/// Not thread-safe.
template <class Item>
class FairQueue {
 public:
  /// At most `share` items of one client wait. Whoever has none waiting is remembered until it
  /// retires, or not at all.
  explicit FairQueue(std::size_t share, bool remember = true)
      : share_(share), remember_(remember) {}

  bool has_room(std::uint64_t client) const {
    const auto found = clients_.find(client);
    return found == clients_.end() || found->second.items.size() < share_;
  }
  /// False, and nothing is queued: the client's share is used up.
  bool push(std::uint64_t client, Item item) {
    if (!has_room(client)) return false;
    const auto [entry, is_new] = clients_.try_emplace(client);
    // In line with those that have waited longest, never before all of them.
    if (is_new) entry->second.served = longest_waiting();
    if (entry->second.items.empty()) entry->second.waits_since = ++clock_;
    entry->second.items.push_back(std::move(item));
    ++size_;
    return true;
  }
  /// Puts back what was popped last, before the other items of its client.
  void push_front(std::uint64_t client, Item item) {
    const auto [found, is_new] = clients_.try_emplace(client);
    Client& entry = found->second;
    if (is_new) {  // it was forgotten when it was popped
      entry.served = clock_;
      entry.retired = true;
    }
    if (entry.items.empty()) entry.waits_since = ++clock_;
    entry.items.push_front(std::move(item));
    ++size_;
  }
  /// The next item and its client.
  std::optional<std::pair<std::uint64_t, Item>> pop() {
    auto next = clients_.end();
    for (auto it = clients_.begin(); it != clients_.end(); ++it) {
      if (it->second.items.empty()) continue;
      if (next == clients_.end() || before(it->second, next->second)) next = it;
    }
    if (next == clients_.end()) return std::nullopt;
    Client& client = next->second;
    std::pair<std::uint64_t, Item> out{next->first, std::move(client.items.front())};
    client.items.pop_front();
    client.served = ++clock_;
    client.waits_since = clock_;
    --size_;
    if ((client.retired || !remember_) && client.items.empty()) clients_.erase(next);
    return out;
  }
  /// The client has gone: what it has waiting is still served, then nothing is remembered of it.
  void retire(std::uint64_t client) {
    const auto found = clients_.find(client);
    if (found == clients_.end()) return;
    found->second.retired = true;
    if (found->second.items.empty()) clients_.erase(found);
  }
  /// Takes everything out, in no order that means anything.
  std::deque<Item> clear() {
    std::deque<Item> all;
    for (auto& [id, client] : clients_) {
      for (Item& item : client.items) all.push_back(std::move(item));
    }
    clients_.clear();
    size_ = 0;
    return all;
  }

  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }

 private:
  struct Client {
    std::deque<Item> items;
    std::uint64_t served = 0;       // by clock_, when an item of it was popped last
    std::uint64_t waits_since = 0;  // by clock_, of its first item
    bool retired = false;
  };
  static bool before(const Client& a, const Client& b) {
    return a.served != b.served ? a.served < b.served : a.waits_since < b.waits_since;
  }
  std::uint64_t longest_waiting() const {
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    for (const auto& [id, client] : clients_) {
      if (!client.items.empty() && client.served < least) least = client.served;
    }
    return least == std::numeric_limits<std::uint64_t>::max() ? 0 : least;
  }

  std::size_t share_;
  bool remember_;
  std::map<std::uint64_t, Client> clients_;
  std::uint64_t clock_ = 0;
  std::size_t size_ = 0;
};

}  // namespace gaitd::daemon
