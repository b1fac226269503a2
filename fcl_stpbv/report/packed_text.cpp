// Compressed data as text: zlib's gzip format, then base64 (RFC 4648).
#include "fcl_stpbv/report/packed_text.h"

#include <zlib.h>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::report {

std::string base64(const void* data, std::size_t size) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const std::size_t left = size - i;
    const unsigned long three = static_cast<unsigned long>(bytes[i]) << 16 |
                                (left > 1 ? static_cast<unsigned long>(bytes[i + 1]) << 8 : 0) |
                                (left > 2 ? static_cast<unsigned long>(bytes[i + 2]) : 0);
    text += kDigits[three >> 18 & 63];
    text += kDigits[three >> 12 & 63];
    text += left > 1 ? kDigits[three >> 6 & 63] : '=';
    text += left > 2 ? kDigits[three & 63] : '=';
  }
  return text;
}

std::string packed(const std::string& text) {
  constexpr int kGzip = 16 + MAX_WBITS;  // zlib's way to ask for gzip's header
  constexpr int kMemory = 8;             // zlib's default
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw Error("zlib: not enough memory to compress the page");
  std::string out(deflateBound(&stream, static_cast<uLong>(text.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int done = deflate(&stream, Z_FINISH);
  const std::size_t size = stream.total_out;
  deflateEnd(&stream);
  if (done != Z_STREAM_END) throw Error("zlib: the page could not be compressed");
  return base64(out.data(), size);
}

}  // namespace fcl_stpbv::report
