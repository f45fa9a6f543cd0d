# Fits each table with glm and brglm2 and compares with the reports that the program wrote; see check-against-r.sh.
suppressMessages({library(brglm2); library(jsonlite)})
arguments <- commandArgs(TRUE)
worst <- 0

design <- function(d, columns) {
  number <- function(name) switch(name,
    constant = 1,
    change1 = d$change == 1, change2 = d$change == 2, change3 = d$change == 3,
    change1_S = (d$change == 1) * d$S, change2_S = (d$change == 2) * d$S,
    change2_E = (d$change == 2) * d$E, change3_E = (d$change == 3) * d$E,
    d[[name]])
  x <- sapply(columns, function(name) as.numeric(number(name)) + numeric(nrow(d)))
  colnames(x) <- columns
  x
}

compare <- function(set, what, ours, theirs, tolerance = 1e-8) {
  off <- max(abs(ours - theirs) / pmax(abs(theirs), 1e-4))
  verdict <- if (off < tolerance) "ok" else "DIFFERS"
  cat(sprintf("%-30s %-28s %9.1e  %s\n", set, what, off, verdict))
  if (off >= tolerance) worst <<- 1
}

for (file in list.files(arguments[1], "^[01].*csv$")) {
  set <- sub("\\.csv$", "", file)
  report <- read_json(file.path(arguments[2], set, "report.json"), simplifyVector = TRUE)
  d <- read.csv(file.path(arguments[1], file), na.strings = c("", "n/a"))
  used <- d$n > 0
  if (!is.null(d$sick)) used <- used & !is.na(d$sick)
  d <- d[used, ]
  x <- design(d, setdiff(report$columns, report$aliased))
  response <- cbind(d$y, d$n - d$y)
  control <- list(epsilon = 1e-14, maxit = 100)
  ml <- suppressWarnings(glm(response ~ x - 1, family = binomial, control = control))
  if (report$ml_valid) {
    # A step of Newton's from R's end, at which the weights are no longer those of the cycle before.
    p <- fitted(ml)
    errors <- sqrt(diag(solve(crossprod(x * sqrt(d$n * p * (1 - p))))))
    compare(set, "glm: estimates", report$ml$estimate, unname(coef(ml)))
    compare(set, "glm: standard errors", report$ml$se, unname(errors))
    compare(set, "glm: deviance", report$ml$deviance, deviance(ml))
    compare(set, "glm: log-likelihood", report$ml$loglik, as.numeric(logLik(ml)))
    compare(set, "glm: fitted values", report$fitted_mu, unname(p * d$n))
    # The loss at a profile bound is the quantile, by a fit with the coefficient as an offset.
    loss <- function(j, bound) {
      held <- suppressWarnings(glm(response ~ x[, -j] - 1, offset = x[, j] * bound, family = binomial, control = control))
      held$deviance - ml$deviance
    }
    bounds <- report$ml$profile_ci95
    losses <- sapply(seq_len(ncol(x)), function(j) c(loss(j, bounds$lo[j]), loss(j, bounds$hi[j])))
    compare(set, "glm: loss at profile bounds", losses, qchisq(0.95, 1) + 0 * losses, 1e-7)
  } else if (report$separation$kind == "quasi") {
    compare(set, "glm: deviance (infimum)", report$ml_limit$deviance_infimum, deviance(ml))
  }
  firth <- suppressWarnings(glm(response ~ x - 1, family = binomial, method = "brglmFit", type = "AS_mean",
                                control = list(epsilon = 1e-13, maxit = 10000)))
  compare(set, "brglm2: estimates", report$firth$estimate, unname(coef(firth)))
  compare(set, "brglm2: standard errors", report$firth$se, unname(sqrt(diag(vcov(firth)))))
}
quit(status = worst)
