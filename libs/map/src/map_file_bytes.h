/// Numbers and strings to little-endian bytes and back; what is not there throws.
#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace djpete::map {

/// Bytes that do not hold what they should. The caller adds the name of the file.
struct DamagedBytes : std::runtime_error {
    using std::runtime_error::runtime_error;
};

template <std::size_t size>
struct BitsOf;
template <>
struct BitsOf<1> {
    using type = uint8_t;
};
template <>
struct BitsOf<4> {
    using type = uint32_t;
};
template <>
struct BitsOf<8> {
    using type = uint64_t;
};

class ByteWriter {
  public:
    /// Integers of 1, 4 or 8 bytes, bool, float, double.
    template <class T>
    void put(T value) {
        static_assert(std::is_arithmetic_v<T>);
        typename BitsOf<sizeof(T)>::type bits;
        std::memcpy(&bits, &value, sizeof(T));
        uint8_t raw[sizeof(T)];
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            raw[i] = static_cast<uint8_t>(static_cast<uint64_t>(bits) >> (8 * i));
        }
        bytes_.insert(bytes_.end(), raw, raw + sizeof(T));
    }
    void putText(const std::string& text) {
        put(static_cast<uint64_t>(text.size()));
        bytes_.insert(bytes_.end(), text.begin(), text.end());
    }
    void append(const std::vector<uint8_t>& bytes) {
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    const std::vector<uint8_t>& bytes() const { return bytes_; }

  private:
    std::vector<uint8_t> bytes_;
};

class ByteReader {
  public:
    ByteReader(const uint8_t* begin, std::size_t size) : at_(begin), end_(begin + size) {}

    std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }

    template <class T>
    T get() {
        static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>);
        need(sizeof(T));
        uint64_t wide = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i)
            wide |= static_cast<uint64_t>(at_[i]) << (8 * i);
        at_ += sizeof(T);
        const auto bits = static_cast<typename BitsOf<sizeof(T)>::type>(wide);
        T value;
        std::memcpy(&value, &bits, sizeof(T));
        return value;
    }
    bool getFlag() {
        const auto value = get<uint8_t>();
        if (value > 1) throw DamagedBytes("a flag is neither 0 nor 1");
        return value == 1;
    }
    /// How many things follow, each at least `bytesEach` bytes long.
    std::size_t getCount(std::size_t bytesEach) {
        const auto count = get<uint64_t>();
        if (count > left() / bytesEach) throw DamagedBytes("a list is longer than the file");
        return static_cast<std::size_t>(count);
    }
    std::string getText() {
        const std::size_t size = getCount(1);
        std::string text(reinterpret_cast<const char*>(at_), size);
        at_ += size;
        return text;
    }

  private:
    void need(std::size_t size) const {
        if (left() < size) throw DamagedBytes("the content ends too early");
    }
    const uint8_t* at_;
    const uint8_t* end_;
};

}  // namespace djpete::map
