// SPDX-License-Identifier: Apache-2.0
#include "cli/view/certificate.h"

#include <fcntl.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
namespace ssl = boost::asio::ssl;

constexpr long kDays = 3650;

struct Free {
  void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
  void operator()(X509* certificate) const { X509_free(certificate); }
  void operator()(BIO* bio) const { BIO_free(bio); }
};
using Key = std::unique_ptr<EVP_PKEY, Free>;
using Cert = std::unique_ptr<X509, Free>;
using Bio = std::unique_ptr<BIO, Free>;

std::string openssl_error() {
  char text[256];
  ERR_error_string_n(ERR_get_error(), text, sizeof(text));
  return text;
}

// Signed by its own key, for the names under which this machine is reached.
Cert make_certificate(EVP_PKEY* key) {
  char name[256] = {};
  if (gethostname(name, sizeof(name) - 1) != 0 || name[0] == '\0') std::strcpy(name, "localhost");
  Cert certificate(X509_new());
  X509_set_version(certificate.get(), 2);
  std::uint32_t serial = 1;
  RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof(serial));
  ASN1_INTEGER_set_uint64(X509_get_serialNumber(certificate.get()), serial | 1u);
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()), -3600);
  X509_gmtime_adj(X509_getm_notAfter(certificate.get()), kDays * 24 * 3600);
  X509_set_pubkey(certificate.get(), key);
  X509_NAME* subject = X509_get_subject_name(certificate.get());
  X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_UTF8,
                             reinterpret_cast<const unsigned char*>(name), -1, -1, 0);
  X509_set_issuer_name(certificate.get(), subject);
  const std::string names = std::string("DNS:") + name + ",DNS:" + name + ".local,DNS:localhost";
  X509_EXTENSION* extension =
      X509V3_EXT_conf_nid(nullptr, nullptr, NID_subject_alt_name, names.c_str());
  if (extension != nullptr) {
    X509_add_ext(certificate.get(), extension, -1);
    X509_EXTENSION_free(extension);
  }
  if (X509_sign(certificate.get(), key, EVP_sha256()) == 0) return nullptr;
  return certificate;
}

std::string make_pem() {
  const Key key(EVP_EC_gen("P-256"));
  const Cert certificate = key ? make_certificate(key.get()) : nullptr;
  const Bio out(BIO_new(BIO_s_mem()));
  if (!certificate || !out || PEM_write_bio_X509(out.get(), certificate.get()) == 0 ||
      PEM_write_bio_PrivateKey(out.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) == 0) {
    return "";
  }
  char* data = nullptr;
  const long size = BIO_get_mem_data(out.get(), &data);
  return {data, static_cast<std::size_t>(size)};
}

// Empty, or why not. A file that is there already is left alone.
std::string write_private(const std::string& file, const std::string& text) {
  std::error_code failed;
  fs::create_directories(fs::path(file).parent_path(), failed);
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (fd < 0) return file + ": cannot write: " + std::strerror(errno);
  const bool done = ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int error = errno;
  ::close(fd);
  return done ? "" : file + ": cannot write: " + std::strerror(error);
}

// Whoever else can read the key can be this server.
bool is_private(const std::string& file) {
  struct stat status {};
  return ::stat(file.c_str(), &status) == 0 && (status.st_mode & 077) == 0;
}

std::string fingerprint_of(const std::string& file) {
  const Bio in(BIO_new_file(file.c_str(), "r"));
  const Cert certificate(in ? PEM_read_bio_X509(in.get(), nullptr, nullptr, nullptr) : nullptr);
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  if (!certificate || X509_digest(certificate.get(), EVP_sha256(), digest, &size) == 0) return "";
  static constexpr char kDigits[] = "0123456789ABCDEF";
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    if (i > 0) text += ':';
    text += kDigits[digest[i] >> 4];
    text += kDigits[digest[i] & 15];
  }
  return text;
}

}  // namespace

std::string certificate_file() {
  if (const char* config = std::getenv("XDG_CONFIG_HOME"); config != nullptr && *config != '\0') {
    return std::string(config) + "/gaitd/view.pem";
  }
  const char* home = std::getenv("HOME");
  return std::string(home != nullptr ? home : ".") + "/.config/gaitd/view.pem";
}

Certificate own_certificate(const std::string& file, std::string* error) {
  if (!fs::exists(file)) {
    const std::string pem = make_pem();
    *error =
        pem.empty() ? "cannot make a certificate: " + openssl_error() : write_private(file, pem);
    if (!error->empty()) return {};
  }
  if (!is_private(file)) {
    *error =
        file + ": others can read the key in it; chmod 600, or remove it, and a new one is made";
    return {};
  }
  Certificate result;
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  context->set_options(ssl::context::default_workarounds | ssl::context::no_tlsv1 |
                       ssl::context::no_tlsv1_1);
  boost::system::error_code failed;
  context->use_certificate_chain_file(file, failed);
  if (!failed) context->use_private_key_file(file, ssl::context::pem, failed);
  result.fingerprint = fingerprint_of(file);
  if (failed || result.fingerprint.empty()) {
    *error = file + ": holds no certificate with its key: " + failed.message() +
             "; remove it, and a new one is made";
    return {};
  }
  result.context = std::move(context);
  return result;
}

}  // namespace gaitd::cli
