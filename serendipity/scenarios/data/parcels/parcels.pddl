; Dora takes a box to the inn and flour from the mill to the market, which is closed to carts.
(define (problem parcels)
  (:domain parcels)
  (:objects dora rolo - driver
            van cart - vehicle
            box flour - parcel
            home depot inn lane mill market - place)
  (:init (path home depot) (path depot home)
         (road depot inn) (road inn depot) (road inn lane) (road lane inn)
         (road lane mill) (road mill lane) (road inn market) (road market inn)
         (open-to van depot) (open-to van inn) (open-to van lane) (open-to van mill) (open-to van market)
         (open-to cart inn) (open-to cart lane) (open-to cart mill)
         (at dora home) (at van depot) (key dora van) (at box depot)
         (at rolo mill) (at cart mill) (key rolo cart) (at flour mill))
  (:goal (and (at box inn) (at flour market))))
