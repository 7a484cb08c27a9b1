; Tom drives ann to the theatre and then ben to the museum. Two taxis without drivers wait, one of them
; on the short way to the museum.
(define (problem taxis)
  (:domain taxis)
  (:objects tom uno due - taxi
            ann ben - guest
            station bridge market theatre gate hotel yard garden park quay pier museum - place)
  (:init (street station bridge) (street bridge station) (street bridge market) (street market bridge)
         (street market theatre) (street theatre market) (street market gate) (street gate market)
         (street gate hotel) (street hotel gate) (street hotel yard) (street yard hotel)
         (street gate garden) (street garden gate) (street garden park) (street park garden)
         (street garden museum) (street museum garden)
         (street gate quay) (street quay gate) (street quay pier) (street pier quay)
         (street pier museum) (street museum pier)
         (at tom station) (at uno garden) (at due yard)
         (room bridge) (room market) (room theatre) (room gate) (room hotel) (room park) (room quay)
         (room pier) (room museum)
         (seat tom) (seat uno) (seat due)
         (at ann station) (at ben hotel))
  (:goal (and (at ann theatre) (at ben museum))))
