// By OpenSSL's libcrypto.
#include "fcl_stpbv/report/digest.h"

#include <openssl/evp.h>

#include <array>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::report {

std::string sha256(std::string_view content) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned size = 0;
  if (EVP_Digest(content.data(), content.size(), bytes.data(), &size, EVP_sha256(), nullptr) != 1)
    throw Error("libcrypto has no SHA-256 here; install Debian's libssl3");
  std::string hex;
  for (unsigned i = 0; i < size; ++i) {
    hex += "0123456789abcdef"[bytes[i] >> 4];
    hex += "0123456789abcdef"[bytes[i] & 15];
  }
  return hex;
}

}  // namespace fcl_stpbv::report
